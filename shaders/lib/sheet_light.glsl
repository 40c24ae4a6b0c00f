// SPDX-License-Identifier: Apache-2.0
// Light of thin layers of cloud, however they are drawn: as meshes (pass/sheet.vert, pass/sheet.frag) or met by rays (lib/march.glsl).
//
// key: illuminance by the key light, lux; around: mean radiance from all other directions; phase: the first scattering's, 1/sr; cosSun:
// between the direction of view and the key light; viewHeight, sunHeight: sines of their elevations.
// Needs lib/phase.glsl, lib/cloud_light.glsl and lib/sheet.glsl before it.

// The key light as its cloud scatters it.
vec3 sheetKey(Sheet sheet, vec3 key) { return sheet.tint * key; }

// Of light from above and below, what arrives in the middle of the sheet and is scattered.
vec3 sheetAround(Sheet sheet, vec3 sky, vec3 ground) {
  vec2 shares = cloudSkyShares(CloudDepths(0.0, 0.0, 0.5 * sheet.typicalDepth, 0.5 * sheet.typicalDepth));
  return sheet.tint * (sky * shares.x + ground * shares.y);
}

// Luminance of typical cloud of the sheet, on its side towards the sun or away from it, for the flat and embossed tiers.
vec3 sheetSide(Sheet sheet, bool sunny, vec3 key, vec3 around, float phase, float cosSun, float viewHeight, float sunHeight) {
  CloudDepths d = CloudDepths(sunny ? 0.1 * sheet.typicalDepth : sheet.typicalDepth, sheet.typicalDepth, 0.5 * sheet.typicalDepth,
                              0.5 * sheet.typicalDepth);
  return key * cloudSunSource(d, phase, cosSun, viewHeight, max(sunHeight, 0.0)) + around;
}

// Embossed: the sheet's side that falls off towards the sun is its sunny side. rise: of the pattern along the step to the sun.
float sheetSunny(float rise) { return clamp(0.5 - rise, 0.0, 1.0); }

// Lit: the way to the sun rises through the sheet while it crosses the pattern. The pattern is asked at these shares of the way, 1/6, 1/2
// and 5/6, squared; weighted by what of the sheet's thickness is still above.
const vec3 kSheetWay = vec3(0.028, 0.25, 0.694);
float sheetDepthToSun(Sheet sheet, vec3 patterns, float sunHeight) {
  float depth = 0.45 * sheetDepth(sheet, patterns.x) + 0.36 * sheetDepth(sheet, patterns.y) + 0.19 * sheetDepth(sheet, patterns.z);
  return 0.5 * depth / max(abs(sunHeight), 0.05);
}
vec3 sheetLit(float depth, float toSun, vec3 key, vec3 around, float phase, float cosSun, float viewHeight, float sunHeight) {
  CloudDepths d = CloudDepths(toSun, 0.5 * depth / max(abs(sunHeight), 0.05), 0.5 * depth, 0.5 * depth);
  return key * cloudSunSource(d, phase, cosSun, viewHeight, max(sunHeight, 0.0)) + around;
}

// Level of a pattern's mipmaps for the way to the sun, seen from a distance.
float sheetWayLevel(float texelsPerPixel, float distanceM) { return log2(max(texelsPerPixel * distanceM, 1.0)); }
