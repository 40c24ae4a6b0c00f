// SPDX-License-Identifier: Apache-2.0
// What lies behind thin clouds, for any OpenGL camera: the clear sky, the discs, the ground with the shadows of the sheets.

#include "lib/phase.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_uniforms.glsl"
#include "lib/sheet.glsl"

const int kMaxShadows = 4;
uniform Sheet uShadowSheets[kMaxShadows];
uniform sampler2D uShadowPattern0;
uniform sampler2D uShadowPattern1;
uniform sampler2D uShadowPattern2;
uniform sampler2D uShadowPattern3;
uniform int uShadowCount;

uniform mat3 uEnuFromCamera;      // OpenGL's camera: x right, y up, z backwards
uniform vec4 uRayScale;           // from clip x, y: xy * clip + zw is the camera ray at depth 1
uniform vec4 uViewportPx;         // x, y, width, height
uniform float uPixelRad;
uniform float uScale;             // written value for each cd/m2

layout(location = 0) out vec4 outColor;

float sheetSunlight(Sheet sheet, sampler2D pattern, vec2 q) {
  vec3 up = vec3(q, 0.0) + uKeyDirection * (sheet.heightM / max(uKeyDirection.z, 0.02));
  float depth = sheetDepth(sheet, texture(pattern, vec2(sheetCoordinate(sheet, up))).x);
  return 1.0 - sheetOpacity(sheet, depth / max(uKeyDirection.z, 0.1));
}

float groundSunlight(vec2 q, float dither) {
  float through = 1.0;
  if (uShadowCount > 0) through *= sheetSunlight(uShadowSheets[0], uShadowPattern0, q);
  if (uShadowCount > 1) through *= sheetSunlight(uShadowSheets[1], uShadowPattern1, q);
  if (uShadowCount > 2) through *= sheetSunlight(uShadowSheets[2], uShadowPattern2, q);
  if (uShadowCount > 3) through *= sheetSunlight(uShadowSheets[3], uShadowPattern3, q);
  return through;
}

#include "lib/background.glsl"

void main() {
  vec2 clip = (gl_FragCoord.xy - uViewportPx.xy) / uViewportPx.zw * 2.0 - 1.0;
  vec3 dir = normalize(uEnuFromCamera * vec3(uRayScale.xy * clip + uRayScale.zw, -1.0));
  outColor = vec4(uScale * backgroundLuminance(dir, groundDistance(dir), uPixelRad, 0.5), 1.0);
}
