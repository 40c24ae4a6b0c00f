// SPDX-License-Identifier: Apache-2.0
// The light that the ground has on average.

#include "lib/ground_light_sums.glsl"

uniform sampler2D uRows;

out vec4 outMean;

void main() {
  const int apart = 3;
  ivec2 size = textureSize(uRows, 0) / apart;
  vec2 sum = vec2(0.0);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) sum += lightOf(texelFetch(uRows, apart * ivec2(x, y), 0));
  outMean = vec4(sum / float(size.x * size.y), 0.0, 0.0);
}
