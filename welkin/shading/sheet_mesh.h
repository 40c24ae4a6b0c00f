// SPDX-License-Identifier: Apache-2.0
// The surfaces of thin layers as triangles about the eye. Pure.
//
// Positions in metres from the ground under the eye: x east, y north, z up. Alpha is 0 at the rim, where the
// surface ends. Triangles turn counter-clockwise as seen from below. Nothing of them depends on the eye's
// height: they follow it.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "welkin/scene/sheet.h"

namespace welkin::shading {

struct SheetMesh {
  static constexpr int kFloats = 4;  // a vertex: x, y, z, alpha
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
};

// A flat square, 20 heights to either side: alpha 1 in its inner third, then falling to 0 at the rim. That is
// Tarantilis's 4 x 4 vertices, the outer ring of which has alpha 0, more finely divided so that air and
// light, which are computed at the vertices, stay smooth.
SheetMesh planeMesh(double heightM);

// The same height above a sphere of the earth's radius, from the zenith to beyond the horizon of an eye on
// the ground (Pallister). Rings grow denser towards the horizon; alpha falls to 0 over the last of them.
SheetMesh skyPlaneMesh(double heightM, double earthRadiusM);

// Tarantilis's dome: rings from the zenith to the horizon, denser there, alpha 1, then .7, .3, 0 on the last
// four. `radiusM` wide, flattened so that its zenith is at heightM.
SheetMesh domeMesh(double heightM, double radiusM, int segments = 20);

// The dome of "Realistic Real-Time Skies": a half sphere with a vertex every ten degrees. Alpha falls to 0
// over the lowest ring.
SheetMesh hemisphereMesh(double radiusM);

SheetMesh meshOf(const scene::Sheet& sheet, double earthRadiusM);

// The same surfaces as formulas, for rays: `shape` and `innerM` of shaders/lib/sheet_surface.glsl. A sky
// plane seen from above it reaches as far as rays do; its mesh stays what it is.
struct SheetShape {
  glm::vec4 shape{0.0f};
  float innerM = 0.0f;
};
SheetShape shapeOf(const scene::Sheet& sheet, double earthRadiusM, double eyeM);

}  // namespace welkin::shading
