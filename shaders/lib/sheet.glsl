// SPDX-License-Identifier: Apache-2.0
// Thin layers of cloud: a pattern of noise on a surface, turned into cloud by condensation.
//
// Opacity by Beer and Lambert from the pattern's excess over a threshold: the one law behind the thesis's, the graphics gem's and the
// course project's formulas (welkin/field/condensation.h has their conversions). Shared by C++ and GLSL, see welkin/core/glsl.h.

struct Sheet {
  vec3 offset;        // of the pattern under the eye, tiles
  vec3 perM;          // tiles a metre along each axis; z = 0: the pattern is flat
  float wrap;         // 1: the pattern lies on a half sphere about the ground under the eye; perM is that of its zenith
  float threshold;    // of the pattern in [0, 1]; cloud is where it is above
  float steepness;    // optical depth, seen square on, of a unit of pattern above the threshold
  float bias;         // the most that the sheet hides, [0, 1]
  float heightM;      // above the ground
  float thicknessM;   // over which its depth is spread, for light that crosses it aslant
  float typicalDepth; // optical depth that its mean light is taken for
  vec3 tint;          // share of light that its cloud scatters
};

// p: in metres from the ground under the eye, z up.
WELKIN_FN vec3 sheetCoordinate(Sheet sheet, vec3 p) {
  // Stereographic, seen from the nadir, so that the pattern keeps its shapes: half as large on the horizon as in the zenith.
  float up = p.z / max(length(p), 1e-3f);
  return sheet.offset + p * sheet.perM * (1.0f + sheet.wrap * (1.0f - up) / (1.0f + up));
}

WELKIN_FN float sheetDepth(Sheet sheet, float pattern) { return sheet.steepness * max(pattern - sheet.threshold, 0.0f); }

WELKIN_FN float sheetOpacity(Sheet sheet, float depth) { return sheet.bias * (1.0f - exp(-depth)); }
