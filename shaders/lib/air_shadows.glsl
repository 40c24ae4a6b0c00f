// SPDX-License-Identifier: Apache-2.0
// Shadows of volumes in the air: what of it the sun reaches along a ray, from the light volume at some places of chance.
//
// Needs lib/phase.glsl, lib/sky_uniforms.glsl, lib/cloud_uniforms.glsl, lib/light_volume.glsl and lib/ground_light.glsl before it, and a uniform sampler3D uLightVolume.

#define WELKIN_AIR_SHADOWS

float airDither = 0.5;            // a pass's, in [0, 1): where in their stretches the places lie

#ifndef WELKIN_AIR_SAMPLES
#define WELKIN_AIR_SAMPLES 16
#endif
const int kAirSamples = WELKIN_AIR_SAMPLES;
const float kAirAll = 0.4;        // air that takes as much light as this, or more, has them all; thinner air, whose shadows are fainter, fewer

bool airShadowsKnown() { return uBandCount != 0; }

// The share of what the air at a distance would add in the sun that it does add, but for what sheets take. Light that clouds turn by some
// degrees only lights the air behind them as if it had not been turned.
float litAirAt(vec3 dir, float t) {
  vec3 q = cloudPosition(vec3(0.0, 0.0, uEyeM) + dir * t, uEarthRadiusM);
  return q.z >= uCloudTopM ? 1.0 : mix(uClearAir, exp(-kDropletAside * cloudDepthToSun(uLightVolume, q)), uKeyCounts);
}

// The share of what the air of [0, distanceM] would add in the sun that it does add. through: what it lets through.
float litAir(vec3 dir, float distanceM, vec3 through) {
  if (!airShadowsKnown()) return uClearAir;
  // Places are spread as light is scattered: evenly in what has been let through.
  float absorbed = 1.0 - through.y;
  float perM = -log(max(through.y, 1e-4)) / max(distanceM, 1.0);
  float lit = 0.0;
  int samples = clamp(int(ceil(absorbed / kAirAll * float(kAirSamples))), kAirSamples / 2, kAirSamples);
  for (int i = 0; i < samples; ++i) {
    float share = (float(i) + airDither) / float(samples);
    float t = absorbed > 1e-3 ? -log(max(1.0 - share * absorbed, 1e-4)) / perM : share * distanceM;
    lit += litAirAt(dir, t);
  }
  return uAirUnderSheets * lit / float(samples);
}

// As aerial(), with these shadows.
void aerialShaded(vec3 dir, float distanceM, out vec3 inscatter, out vec3 through) {
  aerialLit(dir, distanceM, inscatter, through);
  inscatter = shadedAir(dir, inscatter, through, litAir(dir, distanceM, through), lightAboutAir(dir, distanceM));
}

// Light of clouds as it arrives through air, of what they hide. Haze scatters mostly forward: a part of what it takes from a ray is as if it had
// not been turned, for there is cloud about the ray too. In the place of that is the light about the eye that the air has been given. Not so
// what clouds themselves have turned by little, about the sun: the air in their shade has that as sunlight (litAirAt()).
const float kHazeForward = 0.4;
const float kTurned = 0.2;        // 1/sr: of what a cloud turns with a larger share than this, this much
vec3 cloudsThroughAir(vec3 dir, vec3 luminance, float hidden, vec3 through) {
  float red = max(through.x, 1e-4);  // haze takes as much of all colours, molecules little of red
  float turned = min(kTurned / phaseHenyeyGreenstein(dot(dir, uKeyDirection), kDropletAsymmetry), 1.0);
  return luminance * through + turned * (pow(red, -kHazeForward) - 1.0) * through * (luminance - hidden * lightTowards(uHaze, dir));
}

// What they take from the clear sky behind all clouds, for an eye beneath their tops.
vec3 shadowsInSky(vec3 dir) {
  if (uBandCount == 0) return vec3(0.0);
  float topM = uCloudTopM;
  if (uEyeM >= topM) return vec3(0.0);
  float distanceM = sphereCrossings(topM, dir.z).y;
  vec3 lit, through;
  aerialLit(dir, distanceM, lit, through);
  return lit - shadedAir(dir, lit, through, litAir(dir, distanceM, through), lightAboutAir(dir, distanceM));
}
