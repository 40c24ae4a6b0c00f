// SPDX-License-Identifier: Apache-2.0
// Thin layers as rays meet them: their surfaces against the meshes of the same, and their place among
// volumes.
#include "welkin/shading/sheet_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>

#include "tests/testing/skies.h"
#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/shading/sheet_mesh.h"

namespace welkin::shading {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/sheet_surface.glsl"

using scene::SheetSurface;

scene::Sheet sheetOn(SheetSurface surface, double heightM = 1400.0) {
  scene::Sheet sheet;
  sheet.surface = surface;
  sheet.heightM = heightM;
  return sheet;
}

constexpr SheetSurface kSurfaces[] = {SheetSurface::kPlane, SheetSurface::kSkyPlane, SheetSurface::kDome,
                                      SheetSurface::kHemisphere};

// From the eye to every vertex the surface is met where the mesh is, as much of it as the mesh has there.
TEST(SheetSurface, IsThatOfTheMesh) {
  for (const SheetSurface surface : kSurfaces)
    for (const double heightM : {300.0, 1400.0, 9000.0}) {
      const scene::Sheet sheet = sheetOn(surface, heightM);
      const SheetMesh mesh = meshOf(sheet, kEarthRadiusM);
      for (const float eyeM : {2.0f, 250.0f}) {
        const SheetShape s = shapeOf(sheet, kEarthRadiusM, eyeM);
        for (std::size_t i = 0; i < mesh.vertices.size(); i += SheetMesh::kFloats) {
          const float* v = &mesh.vertices[i];
          const glm::vec3 p(v[0], v[1], v[2]), toVertex = p - glm::vec3(0.0f, 0.0f, eyeM);
          const float distance = glm::length(toVertex);
          const vec2 met = sheetCrossings(s.shape, eyeM, toVertex / distance);
          EXPECT_LT(met.x, 0.0f);
          EXPECT_NEAR(met.y / distance, 1.0f, 2e-3f)
              << "surface " << static_cast<int>(surface) << " vertex " << i;
          EXPECT_NEAR(sheetRim(static_cast<int>(surface), s.shape, s.innerM, p), v[3], 2e-3f) << i;
        }
      }
    }
}

TEST(SheetSurface, HasNothingAtItsRim) {
  for (const SheetSurface surface : kSurfaces) {
    const scene::Sheet sheet = sheetOn(surface);
    const SheetShape s = shapeOf(sheet, kEarthRadiusM, 2.0);
    const int kind = static_cast<int>(surface);
    if (surface == SheetSurface::kDome) {
      EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {14000.0f, 0.0f, 0.0f}), 0.0f);
      EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {0.0f, 13990.0f, -50.0f}), 0.0f);
      continue;
    }
    if (surface == SheetSurface::kHemisphere) {
      EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {1400.0f, 0.0f, 0.0f}), 0.0f);
      EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {0.0f, 1399.0f, -50.0f}), 0.0f);
      EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {1378.0f, 0.0f, 244.0f}), 1.0f);
      continue;
    }
    const float end = s.shape.w;
    EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {end, 0.0f, 1400.0f}), 0.0f);
    EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {0.0f, -2.0f * end, 1400.0f}), 0.0f);
    EXPECT_GT(sheetRim(kind, s.shape, s.innerM, {0.0f, 0.999f * end, 1400.0f}), 0.0f);
    EXPECT_EQ(sheetRim(kind, s.shape, s.innerM, {0.0f, 0.5f * s.innerM, 1400.0f}), 1.0f);
  }
}

// An eye above a sky plane looks down through it, and past the lowest point of the ray up through it again.
TEST(SheetSurface, IsMetTwiceFromAbove) {
  const scene::Sheet sheet = sheetOn(SheetSurface::kSkyPlane, 3000.0);
  const float eyeM = 12000.0f;
  const SheetShape s = shapeOf(sheet, kEarthRadiusM, eyeM);
  const glm::vec3 dir(std::cos(radians(3.2)), 0.0f, -std::sin(radians(3.2)));
  const vec2 met = sheetCrossings(s.shape, eyeM, dir);
  EXPECT_GT(met.x, 0.0f);
  EXPECT_GT(met.y, met.x + 50000.0f);
  for (const float t : {met.x, met.y}) {
    const glm::dvec3 p =
        glm::dvec3(0.0, 0.0, kEarthRadiusM + eyeM) + glm::dvec3(dir) * static_cast<double>(t);
    EXPECT_NEAR(glm::length(p) - kEarthRadiusM, 3000.0, 3.0);
    EXPECT_EQ(sheetRim(kSheetSkyPlane, s.shape, s.innerM, glm::vec3(p - glm::dvec3(0, 0, kEarthRadiusM))),
              1.0f);
  }
  // Level, it is not met at all.
  const vec2 level = sheetCrossings(s.shape, eyeM, {1.0f, 0.0f, 0.0f});
  EXPECT_GT(level.x, level.y);
  // A plane is met but once.
  const SheetShape plane = shapeOf(sheetOn(SheetSurface::kPlane, 3000.0), kEarthRadiusM, eyeM);
  const vec2 down = sheetCrossings(plane.shape, eyeM, dir);
  EXPECT_NEAR(down.x, 9000.0 / std::sin(radians(3.2)), 20.0);
  EXPECT_GT(down.y, 1e7f);
}

// Two layers of cloud from 1 to 2 km and from 6 to 7 km.
LightVolumeLayout twoBands() {
  LightVolumeLayout layout;
  layout.bands = {{1000.0f, 2000.0f, 0, 4, {0}}, {6000.0f, 7000.0f, 5, 9, {1}}};
  return layout;
}

std::vector<SheetOnRay> sheetsAt(std::initializer_list<float> heightsM) {
  std::vector<SheetOnRay> sheets;
  for (const float heightM : heightsM) {
    sheets.emplace_back();
    sheets.back().look.heightM = heightM;
  }
  return sheets;
}

TEST(SheetOrder, CutsBandsWhereSheetsGoThrough) {
  const auto sheets = sheetsAt({500.0f, 1300.0f, 4000.0f, 7000.0f, 9000.0f});
  std::string order;
  float lastTop = 0.0f;
  for (const SkyPiece& p : piecesOf(twoBands(), sheets)) {
    order += p.sheet >= 0 ? "s" + std::to_string(p.sheet) + " " : "b" + std::to_string(p.band) + " ";
    if (p.sheet >= 0) continue;
    EXPECT_GE(p.baseM, lastTop);
    EXPECT_GT(p.topM, p.baseM);
    lastTop = p.topM;
  }
  EXPECT_EQ(order, "s0 b0 s1 b0 s2 b1 s3 s4 ");
}

std::string defineOf(const ShaderDefines& defines, const std::string& start) {
  for (const auto& [name, value] : defines)
    if (name.starts_with(start)) return value;
  return "none";
}

// What the ray meets, in order: down to beneath the eye, then up.
TEST(SheetOrder, IsThatOfTheRayFromAnyHeight) {
  auto sheets = sheetsAt({4000.0f, 9000.0f});
  sheets[0].surface = SheetSurface::kPlane;
  const auto ways = [&](double eyeM) {
    const ShaderDefines d = sheetDefines(twoBands(), sheets, eyeM);
    const std::string text = defineOf(d, "WELKIN_EACH_DOWN") + "| " + defineOf(d, "WELKIN_EACH_UP");
    const std::string hits = defineOf(d, "WELKIN_EACH_HIT");
    std::string brief;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      if (word.starts_with("SHEET(")) {
        // Which sheet the hit is of, and whether it is the farther.
        const std::string call = "CALL(" + word.substr(6, word.size() - 7) + ", ";
        const std::size_t at = hits.find(call);
        EXPECT_NE(at, std::string::npos);
        const std::string rest = hits.substr(at + call.size());
        brief += std::string(rest.starts_with("true") ? "far" : "near") + rest[rest.find(", ") + 2] + " ";
      } else if (word.starts_with("BAND(")) {
        brief += "piece" + word.substr(5, word.size() - 6) + " ";
      } else if (word == "|") {
        brief += "| ";
      }
    }
    return brief;
  };
  EXPECT_EQ(ways(2.0), "| piece0 far0 piece2 far1 ");
  EXPECT_EQ(ways(1500.0), "piece0 | piece0 far0 piece2 far1 ");
  EXPECT_EQ(ways(5000.0), "near0 piece0 | piece0 far0 piece2 far1 ");
  EXPECT_EQ(ways(12000.0), "near1 piece2 near0 piece0 | piece0 far0 piece2 far1 ");
}

TEST(SheetOrder, LayersThatAreSheetsAreInNoBand) {
  scene::Scene s = testing::cloudyScene(40.0, {weather::Genus::kCumulus, weather::Genus::kCirrus});
  EXPECT_EQ(lightVolumeLayout(scene::buildSky(s, 0.0)).bands.size(), 2u);
  s.layers[1].technique = scene::Technique::kSkyPlane;
  const scene::SkyState state = scene::buildSky(s, 0.0);
  const LightVolumeLayout layout = lightVolumeLayout(state);
  ASSERT_EQ(layout.bands.size(), 1u);
  EXPECT_EQ(layout.bands[0].layers, std::vector<int>{0});
  EXPECT_EQ(volumesIn(state).size(), 1u);
}

}  // namespace
}  // namespace welkin::shading
