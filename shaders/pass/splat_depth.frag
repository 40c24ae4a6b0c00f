// SPDX-License-Identifier: Apache-2.0
// Light pass: what a ball adds to the optical depths from the light to the ends of four slices. Sums, so that the order of the balls does not matter.

#include "lib/splat.glsl"

in vec2 vAcross;
flat in vec3 vBall;

layout(location = 0) out vec4 outDepth;

void main() {
  float w = max(1.0 - dot(vAcross, vAcross), 0.0), rim = sqrt(w), all = splatColumnTo(w, rim);
  vec4 ends = clamp(vBall.y + vBall.z * vec4(0.0, 1.0, 2.0, 3.0), -rim, rim);
  outDepth = vBall.x * (all + vec4(splatColumnTo(w, ends.x), splatColumnTo(w, ends.y), splatColumnTo(w, ends.z), splatColumnTo(w, ends.w)));
}
