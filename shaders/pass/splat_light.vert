// SPDX-License-Identifier: Apache-2.0
// Light of a ball, at a few places in it: the tile of a texture.

layout(location = 0) in vec4 iBall;     // centre from the eye, radius, m
layout(location = 1) in vec4 iMatter;   // extinction at the centre, 1/m; the tile; phase function; albedo
layout(location = 2) in vec4 iCloud;    // centre of its cloud from the eye; half side of the stack from the eye, 0: there is none
layout(location = 3) in vec4 iHalves;   // half sides and half depths of the stacks towards sun and zenith, m
layout(location = 4) in vec4 iBlock;    // x, y, z: of the stack towards the sun, the others beside it; w: half depth of that from the eye

uniform vec3 uTiles;                    // texels on a tile's side; tiles that there is room for, across and up
uniform float uTilesInRow;

flat out vec4 vBall;
flat out vec4 vMatter;                  // extinction, phase function, albedo
flat out vec4 vCloud;
flat out vec4 vHalves;
flat out vec4 vBlock;
out vec2 vCorner;                       // in the tile's first and last texels' centres -1 and 1

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  vec2 tile = vec2(mod(iMatter.y, uTilesInRow), floor(iMatter.y / uTilesInRow));
  vBall = iBall;
  vMatter = vec4(iMatter.x, iMatter.z, iMatter.w, 0.0);
  vCloud = iCloud;
  vHalves = iHalves;
  vBlock = iBlock;
  vCorner = (corner * 2.0 - 1.0) * (uTiles.x / (uTiles.x - 1.0));
  gl_Position = vec4((tile + corner) / uTiles.yz * 2.0 - 1.0, 0.0, 1.0);
}
