// SPDX-License-Identifier: Apache-2.0
// A sprite of the lens flare, added to what is there. Lenses do not throw all colours to one place: red's disc is a little larger than
// blue's.

#include "lib/lens_flare.glsl"

const float kFringe = 0.025;

uniform float uScale;                      // written value for each cd/m2

in vec2 vCorner;
in vec4 vLight;

layout(location = 0) out vec4 outColor;

void main() {
  float r = length(vCorner);
  vec3 shape;
  if (vLight.w < 0.0) {
    shape = vec3(flareGlow(r));
  } else {
    vec3 size = 1.0 + kFringe * vec3(1.0, 0.0, -1.0);
    shape = vec3(flareGhost(r / size.x, vLight.w), flareGhost(r / size.y, vLight.w), flareGhost(r / size.z, vLight.w)) / (size * size);
  }
  outColor = vec4(uScale * vLight.xyz * shape, 0.0);
}
