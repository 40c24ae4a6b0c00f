// SPDX-License-Identifier: Apache-2.0
// Eye pass: a ball over what is behind it, premultiplied. Its column is exact for the fragment's ray, from the eye on and up to what
// an engine has drawn (WELKIN_ENGINE_DEPTH). WELKIN_DISTANCE: writes how far away it is, too. The picture of a far cloud is there already: it is
// as far away as its middle.

#include "lib/splat.glsl"

in vec3 vRay;
in vec2 vLight;
flat in vec4 vBall;
flat in mat3 vFrame;

uniform float uScale;                     // written value for each cd/m2
uniform sampler2D uLight;
#ifdef WELKIN_ENGINE_DEPTH
uniform sampler2D uDepth;
uniform vec2 uDepthCorner;                // of the part of the target that is drawn to
uniform vec3 uDepthLaw;                   // distance ahead is x / (y + z * depth)
uniform vec3 uAhead;
#endif

layout(location = 0) out vec4 outColor;
#ifdef WELKIN_DISTANCE
layout(location = 1) out vec4 outDistance;
#endif

void main() {
  float across = dot(vRay.xy, vRay.xy), all = across + vRay.z * vRay.z;
  float nearest = vBall.x * vRay.z * inversesqrt(all), end = 1.0;
#ifdef WELKIN_ENGINE_DEPTH
  float depth = texelFetch(uDepth, ivec2(gl_FragCoord.xy - uDepthCorner), 0).x;
  vec3 dir = vFrame * vRay * inversesqrt(all);
  float ahead = uDepthLaw.x / max(uDepthLaw.y + uDepthLaw.z * depth, 1e-20);
  end = clamp(ahead / (max(dot(dir, uAhead), 1e-6) * vBall.z) - nearest, -1.0, 1.0);
#endif
  vec4 light = textureLod(uLight, vLight, 0.0);
  float before = 0.5 + 0.5 * end;  // of the picture, the share that is in front of what has been drawn
  float seen = vBall.w > 0.0 ? before * light.w : 1.0 - exp(-vBall.y * splatColumn(vBall.x * vBall.x * across / all, -nearest, end));
  outColor = vec4(uScale * light.xyz * (vBall.w > 0.0 ? before : seen), seen);
#ifdef WELKIN_DISTANCE
  outDistance = vec4(0.001 * max(nearest, 0.0) * vBall.z, 0.0, 0.0, 1.0) * seen;
#endif
}
