// SPDX-License-Identifier: Apache-2.0
// Light of a place in a cloud of metaballs as it arrives at the eye, with what the air in front adds.
// Needs lib/sky_uniforms.glsl, lib/cloud_light.glsl and lib/light_around.glsl before it.

// Of light through another cloud, as much as slabs let through that absorb nothing (Eddington's solution, scaled by similarity).
float splatThrough(float depth) { return 4.0 / (4.0 + 3.0 * kSimilarity * depth); }

// What is seen, from the eye.
struct SplatPlace {
  vec3 dir;
  float distanceM;
  vec3 fromGround;                // under the eye
  float heightM;
};
SplatPlace splatPlace(vec3 dir, float distanceM) {
  vec3 p = dir * distanceM;
  return SplatPlace(dir, distanceM, vec3(p.xy, p.z + uEyeM), max(p.z + uEyeM + 0.5 * dot(p.xy, p.xy) / uEarthRadiusM, 0.0));
}

// What a lump has of the light that a slab as thick along the same line scatters more than once: it goes out by the other sides, too, and the
// thicker the lump the more by its lit surface, which has less of the light the more it is turned from it. A slab across the light has the same
// everywhere: a thick ball would send out nearly twice what it takes. Fitted, as kTiltAcross and kTiltForward are, to balls and lumps of balls
// traced path by path, within what light is conserved by.
const float kThinLump = 0.72;
const float kThickLump = 0.6;
const float kTurned = 0.3;        // of the light of the surface that faces it, at its edge

// facing: cosine of the angle between the light and the normal of the ellipsoid through the place that is shaped as the cloud is; 0 at its middle.
float splatLump(CloudDepths depths, float facing) {
  float total = kSimilarity * (depths.toSun + depths.fromSun);
  float lit = 0.5 * (facing + sqrt(facing * facing + 0.04));
  return mix(kThinLump, kThickLump * (kTurned + (1.0 - kTurned) * lit), total / (total + 4.0 / 3.0));
}

// q: from the middle of a cloud. halves: of its extent, along the same axes as q and toLight.
float splatFacing(vec3 q, vec3 halves, vec3 toLight) {
  vec3 inHalves = q / halves, normal = inHalves / halves;
  return dot(normal, toLight) / max(length(normal), 1e-9) * min(2.0 * length(inHalves), 1.0);
}

// Of one light. lux: as it arrives through the air. depths: in the cloud itself. shade: optical depth of other clouds before the light. phase: of
// the first scattering, 1/sr.
vec3 splatFromLight(vec3 lux, vec3 toLight, CloudDepths depths, float facing, float shade, float phase, SplatPlace place) {
  float once = cloudSunSourceSingle(depths, phase);
  float all = cloudSunSource(depths, phase, dot(place.dir, toLight), place.dir.z, toLight.z);
  return lux * splatThrough(shade) * (once + splatLump(depths, facing) * (all - once));
}

// By height alone: the sides count by cloudTilt().
const LightWeights kSplatWeights = LightWeights(1.5, 1.0);

// Of the sky and what is beneath. glow: optical depths towards the side that the sky is bright on, and away from it.
vec3 splatFromSky(CloudDepths depths, vec2 glow, vec3 toGlow, SplatPlace place) {
  vec3 upright = vec3(0.0, 0.0, place.dir.z);
  vec2 shares = cloudSkyShares(depths);
  float tilt = 2.0 * cloudTilt(glow.x, glow.y, dot(place.dir, toGlow));  // half-way down, each side has half of it
  return max(lightFromAbove(kSplatWeights, upright, place.heightM) + tilt * sideFromAbove(toGlow, place.heightM), 0.0) * shares.x +
         max(lightFromBelow(kSplatWeights, upright, place.heightM) + tilt * sideFromBelow(toGlow, place.heightM), 0.0) * shares.y;
}

vec3 splatThroughAir(vec3 light, SplatPlace place) {
  vec3 inscatter, through;
  aerial(place.dir, place.distanceM, inscatter, through);
  return light * through + inscatter;
}
