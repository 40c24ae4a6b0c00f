// SPDX-License-Identifier: Apache-2.0
// The surfaces of thin layers as rays meet them: what welkin/shading/sheet_mesh.h lays triangles on. Shared by C++ and GLSL, see
// welkin/core/glsl.h.
//
// One form serves all: a sphere, once heights are stretched. shape: the stretch; the depth of its centre below the ground and the
// height of its top, both stretched; how far from the zenith it ends. A plane has its centre infinitely deep, a sky plane in the
// earth's middle, a dome and a hemisphere on the ground. Positions in metres from the ground under the eye, z up.

WELKIN_CONST int kSheetPlane = 0;  // the kinds, in the order of scene::SheetSurface
WELKIN_CONST int kSheetSkyPlane = 1;
WELKIN_CONST int kSheetDome = 2;
WELKIN_CONST int kSheetHemisphere = 3;

// Distances along a unit direction from the eye to where it enters and leaves; x > y: nowhere. Less than 0: behind. Without
// cancellation, so that planes of any height keep their place.
WELKIN_FN vec2 sheetCrossings(vec4 shape, float eyeM, vec3 dir) {
  vec3 d = vec3(dir.x, dir.y, shape.x * dir.z);
  float eye = shape.x * eyeM;
  float a = dot(d, d);
  float b = (shape.y + eye) * d.z;
  float c = (eye - shape.z) * (2.0f * shape.y + shape.z + eye);
  float disc = b * b - a * c;
  if (disc <= 0.0f) return vec2(1.0f, -1.0f);
  float q = b > 0.0f ? -b - sqrt(disc) : -b + sqrt(disc);
  float one = q / a, other = c / q;
  return vec2(min(one, other), max(one, other));
}

// Square to the surface at p; not normalised.
WELKIN_FN vec3 sheetNormal(vec4 shape, vec3 p) { return vec3(p.x, p.y, shape.x * (shape.x * p.z + shape.y)); }

// How much of the sheet there is at p on it: 1, and falling to exactly 0 at the rim, from innerM on or in the last rings of a dome.
WELKIN_FN float sheetRim(int kind, vec4 shape, float innerM, vec3 p) {
  if (kind == kSheetDome) {
    // Tarantilis's 0, .3, .7, 1 at 0, 0.225, 0.9 and 2.025 degrees of the quarter circle.
    float rise = p.z * shape.x / shape.z;
    if (rise <= 0.0f) return 0.0f;
    if (rise < 0.003927f) return rise * (0.3f / 0.003927f);
    if (rise < 0.015707f) return 0.3f + (rise - 0.003927f) * (0.4f / 0.01178f);
    return min(0.7f + (rise - 0.015707f) * (0.3f / 0.019629f), 1.0f);
  }
  if (kind == kSheetHemisphere) return clamp(p.z / (shape.z * 0.173648f), 0.0f, 1.0f);  // over its last ring, ten degrees
  float far = kind == kSheetPlane ? max(abs(p.x), abs(p.y)) : sqrt(p.x * p.x + p.y * p.y);
  return clamp((shape.w - far) / (shape.w - innerM), 0.0f, 1.0f);
}
