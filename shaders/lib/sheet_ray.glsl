// SPDX-License-Identifier: Apache-2.0
// Thin layers of cloud met by rays, for pictures that march through volumes beside them.
//
// Which sheets there are is compiled in: WELKIN_SHEETS, their number, and WELKIN_EACH_SHEET(CALL), CALL(sheet, kind of surface, tier,
// vector of the pattern's coordinates, kind of sampler, sampler) for each, from the ground up; WELKIN_SHEET_TIER(i), the tier of one of
// them, a constant where all have the same.
// Needs lib/sky_uniforms.glsl, lib/sheet.glsl, lib/sheet_light.glsl and lib/sheet_surface.glsl before it.

uniform Sheet uSheets[WELKIN_SHEETS];
uniform vec4 uSheetShape[WELKIN_SHEETS];    // lib/sheet_surface.glsl
uniform vec4 uSheetRay[WELKIN_SHEETS];      // where the rim begins, m; texels a metre; share of the key light past sheets above; share that it lets through, mean
uniform vec4 uSheetSky[WELKIN_SHEETS];      // mean luminance of the sky over it, cd/m2; w: its tier
uniform vec4 uSheetSunStep[WELKIN_SHEETS];  // uSunStep of pass/sheet.frag

#define WELKIN_DECLARE_SHEET(i, kind, tier, VECTOR, SAMPLER, pattern) uniform SAMPLER pattern;
WELKIN_EACH_SHEET(WELKIN_DECLARE_SHEET)

// Where a ray meets a sheet.
struct SheetHit {
  float distanceM;
  float most;         // that is hidden here; 0: nothing, or not met
  vec3 p;             // m from the ground under the eye
  vec3 coordinate;    // of the pattern
  vec3 across;        // its change over a pixel, to the side and
  vec3 along;         // towards and away from the eye
};

// far: at the farther of two places, that behind the ray's lowest point. endM: of the ray.
SheetHit meetSheet(int i, int kind, bool far, vec3 dir, float endM, float pixelRad) {
  vec2 crossings = sheetCrossings(uSheetShape[i], uEyeM, dir);
  float t = far ? crossings.y : crossings.x;
  SheetHit hit = SheetHit(t, 0.0, vec3(0.0, 0.0, uEyeM) + dir * t, vec3(0.0), vec3(0.0), vec3(0.0));
  if (crossings.x > crossings.y || t <= 0.0 || t >= endM) return hit;
  hit.most = uSheets[i].bias * sheetRim(kind, uSheetShape[i], uSheetRay[i].x, hit.p);
  hit.coordinate = sheetCoordinate(uSheets[i], hit.p);
  // A pixel's two sides on the surface: the level one, and the steep one drawn out by the slant.
  vec3 normal = normalize(sheetNormal(uSheetShape[i], hit.p));
  float slant = dot(normal, dir);
  slant = (slant < 0.0 ? -1.0 : 1.0) * max(abs(slant), 1e-3);
  vec3 side = cross(dir, normal);
  float level = length(side);
  side = level > 1e-4 ? side / level : normalize(vec3(dir.z, 0.0, -dir.x) + 1e-6);
  vec3 steep = cross(side, dir);
  float spanM = t * pixelRad;
  // Over such small ways a bent pattern is turned, but no larger or smaller.
  hit.across = sheetCoordinate(uSheets[i], hit.p + spanM * side) - hit.coordinate;
  hit.along = sheetCoordinate(uSheets[i], hit.p + spanM * (steep - dir * (dot(normal, steep) / slant))) - hit.coordinate;
  return hit;
}

// Luminance of cloud there. texel: of the pattern; way: of the pattern on the way to the sun, for the lit tier; through: the share of the
// key light that volumes before it let through.
vec3 sheetLuminance(int i, int tier, SheetHit hit, vec4 texel, vec3 way, float through, float phase, float cosSun, float viewHeight) {
  vec3 key = uSheetRay[i].z * through * sheetKey(uSheets[i], keyLightAt(uSheets[i].heightM, hit.p));
  vec3 around = sheetAround(uSheets[i], vec3(uSheetSky[i]), uGroundLight);
  float sunHeight = uKeyDirection.z;
  if (tier == 2) {
    float toSun = sheetDepthToSun(uSheets[i], way, sunHeight);
    return sheetLit(sheetDepth(uSheets[i], texel.x), toSun, key, around, phase, cosSun, viewHeight, sunHeight);
  }
  vec3 sunny = sheetSide(uSheets[i], true, key, around, phase, cosSun, viewHeight, sunHeight);
  vec3 shade = sheetSide(uSheets[i], false, key, around, phase, cosSun, viewHeight, sunHeight);
  return mix(shade, sunny, tier == 1 ? sheetSunny(dot(texel.yzw, vec3(uSheetSunStep[i]))) : 0.5);
}
