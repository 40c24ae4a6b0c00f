// SPDX-License-Identifier: Apache-2.0
// Light pass: the block of a stack.

layout(location = 0) in vec4 iBlock;  // texel at its corner, x, y; texels on a slice's side, twice the slices

uniform vec2 uPerTexel;

flat out vec4 vBlock;

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  float columns = iBlock.z > 32.0 ? 8.0 : 4.0;
  vec2 size = iBlock.z * vec2(columns, ceil(0.5 * iBlock.z / columns));
  vBlock = iBlock;
  gl_Position = vec4((iBlock.xy + corner * size) * uPerTexel * 2.0 - 1.0, 0.0, 1.0);
}
