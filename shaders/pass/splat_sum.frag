// SPDX-License-Identifier: Apache-2.0
// Light pass: the slices' optical depths added up from the light on.

#include "lib/splat_stack.glsl"

uniform sampler2D uSlices;

layout(location = 0) out vec4 outDepth;

void main() {
  ivec2 px = ivec2(gl_FragCoord.xy), size = ivec2(int(kSplatTilePx));
  ivec2 tile = px / size, at = px - tile * size;
  int last = tile.y * 8 + tile.x;
  float sum = 0.0;
  for (int i = 0; i <= last; ++i) sum += texelFetch(uSlices, ivec2(i % 8, i / 8) * size + at, 0).x;
  outDepth = vec4(sum, 0.0, 0.0, 0.0);
}
