// SPDX-License-Identifier: Apache-2.0
// Light that the ground has where it is more or less than on average: dark under a thundercloud, bright between clouds. Shares of the
// average around the eye, smooth over some kilometres, by the light volume's depths (lib/ground_light_sums.glsl). Needs lib/sky_uniforms.glsl, lib/clouds.glsl
// and lib/light_volume.glsl before it.

#include "lib/ground.glsl"

uniform sampler2D uGroundShares;  // x: of the light of sky and clouds, y: of all

const float kGroundSeenM = 8e3;         // from so high up one sees so much of the ground that it is as on average
const float kAirAboutM = 8e3;           // the middle of what of the air is seen at most

vec2 groundSharesAt(vec2 q) {
  vec2 at = (q + uLightShiftM) / kGroundSharesHalfM;
  vec2 shares = vec2(textureLod(uGroundShares, clamp(0.5 * at + 0.5, 0.0, 1.0), 0.0));
  return mix(shares, vec2(1.0), clamp(5.0 * max(abs(at.x), abs(at.y)) - 4.0, 0.0, 1.0));
}

// The same as seen from q, over the ground.
vec2 groundSharesFrom(vec3 q) { return mix(groundSharesAt(vec2(q)), vec2(1.0), clamp(q.z / kGroundSeenM, 0.0, 1.0)); }

// The light about the air at a distance along a ray, in that on average: as about the ground there.
float lightAboutAirAt(vec3 dir, float distanceM) {
  return groundSharesFrom(cloudPosition(vec3(0.0, 0.0, uEyeM) + dir * distanceM, uEarthRadiusM)).x;
}
// The same of all of the way there.
float lightAboutAir(vec3 dir, float distanceM) { return lightAboutAirAt(dir, min(0.5 * distanceM, kAirAboutM)); }
