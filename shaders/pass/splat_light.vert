// SPDX-License-Identifier: Apache-2.0
// Light of a ball, at a few places in it: the tile of a texture.

layout(location = 0) in vec4 iBall;     // centre from the eye, radius, m
layout(location = 1) in vec4 iMatter;   // extinction at the centre, 1/m; phase function and how much the stack from the eye counts; albedo; texel at the corner of the stack towards the bright side of the sky, x
layout(location = 2) in vec4 iCloud;    // centre of its cloud from the eye; half side of the stack from the eye, 0: there is none
layout(location = 3) in vec4 iHalves;   // half sides and half depths of the stacks towards sun and zenith, m
layout(location = 4) in vec4 iOthers;   // of the stacks towards the bright side of the sky and towards the second light
layout(location = 5) in vec4 iBlock;    // x, y, z: of the stack towards the sun, the others beside it; w: half depth of that from the eye
layout(location = 6) in vec4 iTile;     // texel at the corner of its tile, x, y; texels on its side; y of that stack

uniform vec2 uPerTexel;

flat out vec4 vBall;
flat out vec4 vMatter;                  // extinction, phase function, albedo
flat out vec4 vCloud;
flat out vec4 vHalves;
flat out vec4 vOthers;
flat out vec2 vGlow;                    // that texel
flat out vec4 vBlock;
out vec2 vCorner;                       // in the tile's first and last texels' centres -1 and 1

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  vBall = iBall;
  vMatter = iMatter;
  vCloud = iCloud;
  vHalves = iHalves;
  vOthers = iOthers;
  vGlow = vec2(iMatter.w, iTile.w);
  vBlock = iBlock;
  vCorner = (corner * 2.0 - 1.0) * (iTile.z / (iTile.z - 1.0));
  gl_Position = vec4((iTile.xy + corner * iTile.z) * uPerTexel * 2.0 - 1.0, 0.0, 1.0);
}
