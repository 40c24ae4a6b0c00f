// SPDX-License-Identifier: Apache-2.0
// Eye pass: a ball over what is behind it, premultiplied. Its column is exact for the fragment's ray, from the eye on.

#include "lib/splat.glsl"

in vec3 vRay;
in vec3 vLight;
flat in vec3 vBall;

layout(location = 0) out vec4 outColor;

void main() {
  float across = dot(vRay.xy, vRay.xy), all = across + vRay.z * vRay.z;
  float nearest = vBall.x * vRay.z * inversesqrt(all);
  float depth = vBall.y * splatColumn(vBall.x * vBall.x * across / all, -nearest, 1.0);
  outColor = vec4(vLight, 1.0) * (1.0 - exp(-depth));
}
