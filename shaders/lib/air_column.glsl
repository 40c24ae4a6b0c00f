// SPDX-License-Identifier: Apache-2.0
// Air and clouds along one ray, from the eye away, segment by segment: what arrives from in front of a distance, and what arrives from
// there. The columns of froxels of render::AirVolume, in compute and in fragment passes.
//
// The whole march, with all that it needs, comes with it. The pass defines WELKIN_SEGMENTS.

#include "lib/phase.glsl"
#include "lib/eclipse.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/light_around.glsl"
#include "lib/cloud_light_fit.glsl"
#include "lib/cloud_scattering.glsl"
#include "lib/light_volume.glsl"
#include "lib/fluence.glsl"
#include "lib/ground_light.glsl"
#ifdef WELKIN_SHEETS
#include "lib/sheet.glsl"
#include "lib/sheet_surface.glsl"
#include "lib/sheet_light.glsl"
#include "lib/sheet_ray.glsl"
#include "lib/sheet_shadows.glsl"
#endif
#include "lib/dither.glsl"
#include "lib/march.glsl"
#include "lib/air_shadows.glsl"

float groundSunlight(vec2 q) { return 1.0; }  // of no ground
float groundSkylight(vec2 q) { return 1.0; }

#include "lib/background.glsl"
#include "lib/air_volume.glsl"

uniform mat3 uEnuFromCamera;      // OpenGL's camera: x right, y up, z backwards
uniform vec4 uRayScale;           // from clip x, y: xy * clip + zw is the camera ray at depth 1
uniform float uPixelRad;          // angle of a column
uniform ivec3 uSize;              // columns across and up, slices
uniform vec2 uNearFarM;
uniform float uScale;             // written for each cd/m2

const float kHalfMost = 65000.0;

struct AirRay {
  vec3 dir;
  float groundM;
  float glowM;                    // air beyond is over all clouds
  float cosSun;
  FirstPhases phases;
  vec2 dither;
};

// What a column has come to.
struct AirColumn {
  vec3 luminance;                 // that arrives, cd/m2
  float clouds;                   // the share that clouds alone let through
};

// What arrives of what is behind a slice.
struct AirSlice {
  vec3 colour, transmittance;
};

#ifdef WELKIN_SHEETS
float airSheetM[WELKIN_HITS];     // where the ray meets sheets,
float airSheetAlpha[WELKIN_HITS]; // how much of them,
vec3 airSheetLight[WELKIN_HITS];  // and their light as it arrives
#endif

AirRay airRay(ivec2 column) {
  vec2 clip = (vec2(column) + 0.5) / vec2(uSize) * 2.0 - 1.0;
  vec3 dir = normalize(uEnuFromCamera * vec3(uRayScale.xy * clip + uRayScale.zw, -1.0));
  float cosSun = dot(dir, uKeyDirection);
  FirstPhases phases = cloudPhases(dir, cosSun);
  vec2 dither = dithersOf(vec2(column), vec2(0.0)).steps;
  float groundM = groundDistance(dir);
#ifdef WELKIN_SHEETS
  float endM = groundM, pixelRad = uPixelRad;
  SheetSeen seen[WELKIN_HITS];
  WELKIN_EACH_HIT(WELKIN_SEE)
  for (int k = 0; k < uHits; ++k) {
    airSheetM[k] = seen[k].hit.distanceM;
    airSheetAlpha[k] = seen[k].alpha;
    airSheetLight[k] = vec3(0.0);
    if (seen[k].alpha > 0.0) {
      vec3 inscatter, through;
      aerialLit(dir, seen[k].hit.distanceM, inscatter, through);
      airSheetLight[k] = ownLightOfSheet(seen[k], dir, phases, cosSun) * through;
    }
  }
#endif
  vec2 tops = sphereCrossings(uOverClouds.w, dir.z);
  return AirRay(dir, groundM, tops.x <= tops.y ? max(tops.y, 0.0) : 0.0, cosSun, phases, dither);
}

// The share of the air's light in the sun that a segment has.
float litSegment(AirRay ray, float fromM, float toM) {
  if (!airShadowsKnown()) return uClearAir;
  return uAirUnderSheets * 0.5 * (litAirAt(ray.dir, mix(fromM, toM, 0.25)) + litAirAt(ray.dir, mix(fromM, toM, 0.75)));
}

#ifdef WELKIN_SHEETS
void addSheet(int k, float fromM, float toM, inout MarchState state, inout float bySheets) {
  if (airSheetAlpha[k] <= 0.0 || airSheetM[k] < fromM || airSheetM[k] >= toM) return;
  float share = state.transmittance * airSheetAlpha[k];
  state.sheets += share * airSheetLight[k];
  state.weightedDepth += share * airSheetM[k];
  state.weight += share;
  state.transmittance -= share;
  bySheets += share;
}
#endif

// Carries a column from one distance to the next.
AirSlice airSegment(AirRay ray, float fromM, float toM, inout AirColumn column) {
  fromM = min(fromM, ray.groundM);
  toM = min(toM, ray.groundM);
  float before = column.clouds;
#ifdef WELKIN_SHEETS
  MarchState state = MarchState(vec3(0.0), before, 0.0, 0.0, 0, vec3(0.0));
#else
  MarchState state = MarchState(vec3(0.0), before, 0.0, 0.0, 0);
#endif
  vec2 stretch;
  float bySheets = 0.0;           // hidden by them
#define WELKIN_SEGMENT(bounds, band, up)                          \
  stretch = bandStretch(vec2(bounds), up, ray.dir.z);             \
  stretch = vec2(max(stretch.x, fromM), min(stretch.y, toM));     \
  state.steps = 0;                                                \
  if (stretch.x < stretch.y)                                      \
    marchBand(band, stretch, ray.dir, uPixelRad, ray.phases, ray.cosSun, ray.dither, state);
#ifdef WELKIN_SHEETS
#define WELKIN_SEGMENT_DOWN(p, band) WELKIN_SEGMENT(uPieces[p], band, false)
#define WELKIN_SEGMENT_UP(p, band) WELKIN_SEGMENT(uPieces[p], band, true)
#define WELKIN_SEGMENT_SHEET(k) addSheet(k, fromM, toM, state, bySheets);
  WELKIN_EACH_DOWN(WELKIN_SEGMENT_DOWN, WELKIN_SEGMENT_SHEET)
  WELKIN_EACH_UP(WELKIN_SEGMENT_UP, WELKIN_SEGMENT_SHEET)
  column.luminance += state.sheets;
#else
#define WELKIN_SEGMENT_DOWN(b) WELKIN_SEGMENT(uBands[b], b, false)
#define WELKIN_SEGMENT_UP(b) WELKIN_SEGMENT(uBands[b], b, true)
  WELKIN_EACH_BAND_DOWN(WELKIN_SEGMENT_DOWN)
  WELKIN_EACH_BAND_UP(WELKIN_SEGMENT_UP)
#endif
  // Air before the clouds of the segment shines through those of earlier ones, air behind them through all.
  vec3 nearLit, nearThrough, farLit, farThrough, middleLit, middleThrough;
  aerialLit(ray.dir, fromM, nearLit, nearThrough);
  aerialLit(ray.dir, toM, farLit, farThrough);
  float about = lightAboutAirAt(ray.dir, 0.5 * (fromM + toM));
  float lit = litSegment(ray, fromM, toM), glow = clamp((ray.glowM - fromM) / max(toM - fromM, 1.0), 0.0, 1.0);
  if (state.weight > 0.0) {
    aerialLit(ray.dir, clamp(state.weightedDepth / state.weight, fromM, toM), middleLit, middleThrough);
  } else {
    middleLit = farLit;
    middleThrough = farThrough;
  }
  column.luminance += cloudsThroughAir(ray.dir, state.luminance, state.weight - bySheets, middleThrough);
  column.luminance += before * max(airBetween(ray.dir, nearLit, nearThrough, middleLit, middleThrough, lit, glow, about), 0.0);
  column.luminance += state.transmittance * max(airBetween(ray.dir, middleLit, middleThrough, farLit, farThrough, lit, glow, about), 0.0);
  column.clouds = state.transmittance;
  return AirSlice(min(uScale * column.luminance, kHalfMost), column.clouds * farThrough);
}
