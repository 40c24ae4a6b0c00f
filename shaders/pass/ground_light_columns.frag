// SPDX-License-Identifier: Apache-2.0
// Averages along columns of what was averaged along rows, and their light as shares of the mean.

#include "lib/ground.glsl"
#include "lib/ground_light_sums.glsl"

uniform sampler2D uRows;
uniform sampler2D uMean;
uniform float uBroken;            // 0: closed clouds, in which light spreads evenly and whose gaps far away nobody sees

out vec4 outShares;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int side = textureSize(uRows, 0).y;
  float apart = 2.0 * kGroundSharesHalfM / float(side) / uSpreadM;  // in deviations
  int reach = int(2.5 / apart);
  vec4 sum = vec4(0.0);
  vec2 weights = vec2(0.0);
  for (int i = -reach; i <= reach; ++i) {
    vec2 weight = weightsAt(float(i) * apart);
    sum += weight.xxxy * texelFetch(uRows, ivec2(at.x, clamp(at.y + i, 0, side - 1)), 0);
    weights += weight;
  }
  vec2 shares = lightOf(sum / weights.xxxy) / max(texelFetch(uMean, ivec2(0), 0).xy, 1e-6);
  outShares = vec4(mix(vec2(1.0), shares, uBroken), 0.0, 0.0);
}
