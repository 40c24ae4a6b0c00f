// SPDX-License-Identifier: Apache-2.0
// Light pass: a ball in one slice of the stack.

#include "lib/splat_stack.glsl"

layout(location = 0) in vec4 iBall;   // centre from the eye, radius, m
layout(location = 1) in vec4 iSlice;  // extinction at the centre, 1/m; slice

uniform SplatStack uStack;

out vec2 vAcross;                     // radii from the centre
flat out vec4 vBall;                  // optical depth of a radius; begin and end of the slice, radii from the centre

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vec3 q = iBall.xyz - uStack.centreM;
  vec2 at = (vec2(dot(q, uStack.across), dot(q, uStack.upward)) + corner * iBall.w) / uStack.halfM;
  float thick = 2.0 * uStack.halfDepthM / float(kSplatSlices);
  float begin = iSlice.y * thick - uStack.halfDepthM - dot(q, uStack.away);
  vAcross = corner;
  vBall = vec4(iSlice.x * iBall.w, begin / iBall.w, (begin + thick) / iBall.w, 0.0);
  gl_Position = vec4(splatTile(int(iSlice.y), at) * 2.0 - 1.0, 0.0, 1.0);
}
