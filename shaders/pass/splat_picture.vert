// SPDX-License-Identifier: Apache-2.0
// Picture of a far cloud: the tile of a texture.

layout(location = 0) in vec4 iPlace;    // middle of its box from the eye; width, m
layout(location = 1) in vec4 iShape;    // half the sides of the box, in widths; its number among the shapes
layout(location = 2) in vec4 iMatter;   // cosine and sine of its turn; optical depth of a width of density 1; share of it that is drawn
layout(location = 3) in vec4 iTile;     // texel at the corner of its tile, x, y; texels across and upward
layout(location = 4) in vec4 iShade;    // stack of what shades it: half side, half depth, m; texel at its corner, x, y
layout(location = 5) in vec4 iTexel;    // x: side of a texel at the middle's distance, m; y: texels on a slice's side of the stack

uniform vec2 uPerTexel;

flat out vec4 vPlace;
flat out vec4 vShape;
flat out vec4 vMatter;
flat out vec4 vShade;
flat out vec4 vTexel;
out vec2 vAcross;                       // m from the middle, at its distance

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  vPlace = iPlace;
  vShape = iShape;
  vMatter = iMatter;
  vShade = iShade;
  vTexel = iTexel;
  vAcross = (corner - 0.5) * iTile.zw * iTexel.x;
  gl_Position = vec4((iTile.xy + corner * iTile.zw) * uPerTexel * 2.0 - 1.0, 0.0, 1.0);
}
