// SPDX-License-Identifier: Apache-2.0
// What thin layers let through on the way to the key light.
//
// Needs lib/sky_uniforms.glsl and lib/sheet.glsl before it, and lib/sheet_ray.glsl where there are rays to meet them.

float sheetSunlight(Sheet sheet, sampler2D pattern, vec3 q) {
  if (q.z >= sheet.heightM) return 1.0;
  vec3 at = q + uKeyDirection * ((sheet.heightM - q.z) / max(uKeyDirection.z, 0.02));
  float depth = sheetDepth(sheet, textureLod(pattern, vec2(sheetCoordinate(sheet, at)), 0.0).x);
  return 1.0 - sheetOpacity(sheet, depth / max(uKeyDirection.z, 0.1));
}

// sheetsSunlight(q): from q, metres from the ground under the eye, z up.
#ifdef WELKIN_SHEETS
// Of the sheets that a march meets, lib/sheet_ray.glsl.
float sheetsSunlight(vec3 q) {
  float through = 1.0;
#define WELKIN_SHADOW(i, pattern) through *= sheetSunlight(uSheets[i], pattern, q);
#define WELKIN_SHADOW_MEAN(i) through *= q.z < uSheets[i].heightM ? uSheetRay[i].w : 1.0;
  WELKIN_EACH_SHADOW(WELKIN_SHADOW, WELKIN_SHADOW_MEAN)
  return through;
}
#else
const int kMaxShadows = 4;
uniform Sheet uShadowSheets[kMaxShadows];
uniform sampler2D uShadowPattern0;
uniform sampler2D uShadowPattern1;
uniform sampler2D uShadowPattern2;
uniform sampler2D uShadowPattern3;
uniform int uShadowCount;
uniform float uShadowMean;         // what all other sheets let through, on average

float sheetsSunlight(vec3 q) {
  float through = uShadowMean;
  if (uShadowCount > 0) through *= sheetSunlight(uShadowSheets[0], uShadowPattern0, q);
  if (uShadowCount > 1) through *= sheetSunlight(uShadowSheets[1], uShadowPattern1, q);
  if (uShadowCount > 2) through *= sheetSunlight(uShadowSheets[2], uShadowPattern2, q);
  if (uShadowCount > 3) through *= sheetSunlight(uShadowSheets[3], uShadowPattern3, q);
  return through;
}
#endif
