// SPDX-License-Identifier: Apache-2.0
// A ghost: a soft disc or ring, added to what is there.

uniform float uScale;

in vec2 vCorner;
in vec4 vLight;

layout(location = 0) out vec4 outColor;

void main() {
  float r = length(vCorner);
  float disc = 1.0 - smoothstep(0.8, 1.0, r);
  float ring = disc * smoothstep(0.35, 0.9, r);
  float glow = (1.0 - smoothstep(0.0, 1.0, r));
  // Below nought: a glow that falls off from its middle.
  float shape = vLight.w < 0.0 ? glow * glow * glow : mix(disc, ring, vLight.w);
  outColor = vec4(uScale * vLight.xyz * shape, 0.0);
}
