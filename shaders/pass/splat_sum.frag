// SPDX-License-Identifier: Apache-2.0
// Light pass: the slices' optical depths added up from the light on.

flat in vec4 vBlock;

uniform sampler2D uSlices;

layout(location = 0) out vec4 outDepth;

void main() {
  int side = int(vBlock.z), columns = vBlock.z > 32.0 ? 8 : 4;
  ivec2 corner = ivec2(vBlock.xy), px = ivec2(gl_FragCoord.xy) - corner;
  ivec2 tile = px / side, at = corner + px - tile * side;
  int last = tile.y * columns + tile.x;
  float sum = 0.0;
  for (int i = 0; i <= last; ++i) sum += texelFetch(uSlices, at + ivec2(i % columns, i / columns) * side, 0).x;
  outDepth = vec4(sum, 0.0, 0.0, 0.0);
}
