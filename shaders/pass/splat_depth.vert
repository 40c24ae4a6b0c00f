// SPDX-License-Identifier: Apache-2.0
// Light pass: a ball in one slice of a stack.

layout(location = 0) in vec4 iPlace;  // texel of its centre, x, y; texels of its radius; optical depth of a radius
layout(location = 1) in vec4 iSlice;  // begin and end of the slice, radii from the centre

uniform vec2 uPerTexel;

out vec2 vAcross;                     // radii from the centre
flat out vec3 vBall;                  // optical depth of a radius; begin and end of the slice

void main() {
  vAcross = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vBall = vec3(iPlace.w, iSlice.xy);
  gl_Position = vec4((iPlace.xy + vAcross * iPlace.z) * uPerTexel * 2.0 - 1.0, 0.0, 1.0);
}
