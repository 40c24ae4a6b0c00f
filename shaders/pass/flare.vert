// SPDX-License-Identifier: Apache-2.0
// One ghost of the lens flare a triangle pair. How much of the light arrives is found here, once a ghost, with nothing read back:
// through the clouds, averaged over the sun's glow, and past what an engine has drawn, by its depths around the sun.

#include "lib/phase.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/sheet.glsl"
#include "lib/sheet_shadows.glsl"

const int kMaxGhosts = 8;
layout(location = 0) in vec3 iCorner;      // x, y in [-1, 1], ghost
uniform vec4 uGhosts[kMaxGhosts];          // centre and half size in clip space
uniform vec4 uGhostLight[kMaxGhosts];      // colour times strength; w: how hollow, 0 a disc and 1 a ring
uniform sampler2D uDepth;                  // the engine's, where it gives one
uniform float uHasDepth;
uniform vec2 uSunAt;                       // texture coordinates of the sun in uDepth
uniform vec2 uSunSize;                     // of its glow there

out vec2 vCorner;
out vec4 vLight;

float arrives() {
  float through = 0.0;
  for (int i = 0; i < 16; ++i) {
    // An even spread over the disc about the sun (Vogel's spiral).
    float r = sqrt((float(i) + 0.5) / 16.0);
    float a = 2.39996 * float(i);
    vec2 o = r * vec2(cos(a), sin(a));
    float seen = 1.0;
    if (uHasDepth > 0.5) seen = textureLod(uDepth, uSunAt + o * uSunSize, 0.0).x >= 1.0 ? 1.0 : 0.0;
    // Directions a degree about the sun are shifts of the eye, for a surface that is far.
    through += seen * sheetsSunlight(vec3(o * (0.017 * 3000.0), uEyeM));
  }
  return through / 16.0;
}

void main() {
  int ghost = int(iCorner.z + 0.5);
  vec4 place = uGhosts[ghost];
  gl_Position = vec4(place.xy + iCorner.xy * place.zw, 0.0, 1.0);
  vCorner = iCorner.xy;
  vLight = vec4(uGhostLight[ghost].xyz * arrives(), uGhostLight[ghost].w);
}
