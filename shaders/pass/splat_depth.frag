// SPDX-License-Identifier: Apache-2.0
// Light pass: what a ball adds to the optical depth of a slice. Sums, so that the order of the balls does not matter.

#include "lib/splat.glsl"

in vec2 vAcross;
flat in vec3 vBall;

layout(location = 0) out vec4 outDepth;

void main() {
  outDepth = vec4(vBall.x * splatColumn(dot(vAcross, vAcross), vBall.y, vBall.z), 0.0, 0.0, 0.0);
}
