// SPDX-License-Identifier: Apache-2.0
// What the clouds over the ground do to its light, averaged along rows. Depths from the ground up are asked for alone: WELKIN_BANDS is 1.

#include "lib/phase.glsl"
#include "lib/cloud_layer.glsl"
#include "lib/cloud_light.glsl"
#include "lib/light_volume.glsl"
#include "lib/ground.glsl"
#include "lib/ground_light_sums.glsl"

uniform sampler3D uLightVolume;
uniform vec2 uSizePx;

const int kReach = 12;            // places to each side,
const float kApart = 0.2;         // in deviations

vec3 cloudsOver(vec2 q) {
  float up = lightVolumeAt(uLightVolume, vec3(q, uBands[0].x)).y;
  float clear = exp(-kDropletAside * up);
  float diffuse = 4.0 / 3.0 / (4.0 / 3.0 + kSimilarity * up);
  return vec3(clear + (1.0 - clear) * diffuse * (1.0 + uSunOverSky),
              exp(-kDropletAside * cloudDepthToSun(uLightVolume, vec3(q, 0.0))), clear);
}

out vec4 outSums;                 // as lightOf() takes them

void main() {
  vec2 q = (2.0 * gl_FragCoord.xy / uSizePx - 1.0) * kGroundSharesHalfM;
  vec4 sum = vec4(0.0);
  vec2 weights = vec2(0.0);
  for (int i = -kReach; i <= kReach; ++i) {
    float x = float(i) * kApart;
    vec2 weight = weightsAt(x);
    vec3 clouds = cloudsOver(q + vec2(x * uSpreadM, 0.0));
    sum += vec4(weight.x * clouds, weight.y * clouds.y);
    weights += weight;
  }
  outSums = sum / weights.xxxy;
}
