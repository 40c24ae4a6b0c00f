// SPDX-License-Identifier: Apache-2.0
// Shadows of volumes in the air: what of it the sun reaches along a ray, from the light volume at some places of chance.
//
// Needs lib/phase.glsl, lib/sky_uniforms.glsl, lib/cloud_uniforms.glsl and lib/light_volume.glsl before it, and a uniform sampler3D uLightVolume.

#define WELKIN_AIR_SHADOWS

float airDither = 0.5;            // a pass's, in [0, 1): where in their stretches the places lie

const int kAirSamples = 4;

bool airShadowsKnown() { return uBandCount != 0 && uLineTowardsSun >= 0.5; }

// The share of what the air at a distance would add in the sun that it does add, but for what sheets take. Light that clouds turn by some
// degrees only lights the air behind them as if it had not been turned.
float litAirAt(vec3 dir, float t) {
  vec3 q = cloudPosition(vec3(0.0, 0.0, uEyeM) + dir * t, uEarthRadiusM);
  return q.z >= uBands[uBandCount - 1].y ? 1.0 : exp(-kDropletAside * cloudDepthToSun(uLightVolume, q));
}

// The share of what the air of [0, distanceM] would add in the sun that it does add. through: what it lets through.
float litAir(vec3 dir, float distanceM, vec3 through) {
  if (!airShadowsKnown()) return uClearAir;
  // Places are spread as light is scattered: evenly in what has been let through.
  float absorbed = 1.0 - through.y;
  float perM = -log(max(through.y, 1e-4)) / max(distanceM, 1.0);
  float lit = 0.0;
  for (int i = 0; i < kAirSamples; ++i) {
    float share = (float(i) + airDither) / float(kAirSamples);
    float t = absorbed > 1e-3 ? -log(max(1.0 - share * absorbed, 1e-4)) / perM : share * distanceM;
    lit += litAirAt(dir, t);
  }
  return uAirUnderSheets * lit / float(kAirSamples);
}

// As aerial(), with these shadows.
void aerialShaded(vec3 dir, float distanceM, out vec3 inscatter, out vec3 through) {
  aerialLit(dir, distanceM, inscatter, through);
  inscatter = shadedAir(inscatter, through, litAir(dir, distanceM, through));
}

// What they take from the clear sky behind all clouds, for an eye beneath their tops.
vec3 shadowsInSky(vec3 dir) {
  if (uBandCount == 0) return vec3(0.0);
  float topM = uBands[uBandCount - 1].y;
  if (uEyeM >= topM) return vec3(0.0);
  float distanceM = sphereCrossings(topM, dir.z).y;
  vec3 lit, through;
  aerialLit(dir, distanceM, lit, through);
  return lit - shadedAir(lit, through, litAir(dir, distanceM, through));
}
