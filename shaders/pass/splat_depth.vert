// SPDX-License-Identifier: Apache-2.0
// Light pass: a ball in four slices of a stack.

layout(location = 0) in vec4 iPlace;  // texel of its centre, x, y; texels of its radius; optical depth of a radius
layout(location = 1) in vec4 iSlice;  // end of the first slice, radii from the centre; its thickness; the tile that is drawn to: 256 * left + side, lower; 0: no bounds

uniform vec2 uPerTexel;

out vec2 vAcross;                     // radii from the centre
flat out vec3 vBall;                  // optical depth of a radius; end of the first slice, its thickness

void main() {
  vAcross = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vBall = vec3(iPlace.w, iSlice.xy);
  vec2 at = iPlace.xy + vAcross * iPlace.z;
  if (iSlice.z > 0.0) {
    float left = floor(iSlice.z / 256.0);
    vec2 corner = vec2(left, iSlice.w);
    at = clamp(at, corner, corner + (iSlice.z - 256.0 * left));
    vAcross = (at - iPlace.xy) / iPlace.z;
  }
  gl_Position = vec4(at * uPerTexel * 2.0 - 1.0, 0.0, 1.0);
}
