// SPDX-License-Identifier: Apache-2.0
// Meshes and looks of thin layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/shading/sheet_look.h"
#include "welkin/shading/sheet_mesh.h"

namespace welkin::shading {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/sheet.glsl"

struct Vertex {
  glm::dvec3 p;
  float alpha;
};
Vertex vertexOf(const SheetMesh& mesh, std::size_t i) {
  const float* v = &mesh.vertices[SheetMesh::kFloats * i];
  return {{v[0], v[1], v[2]}, v[3]};
}
std::size_t vertexCount(const SheetMesh& mesh) {
  return mesh.vertices.size() / SheetMesh::kFloats;
}

const SheetMesh kMeshes[] = {planeMesh(1200.0), skyPlaneMesh(1200.0, kEarthRadiusM), domeMesh(550.0, 5500.0),
                             hemisphereMesh(2000.0)};

// Edges that one triangle alone has are the mesh's rim; there is no other hole, above all none at a meridian.
TEST(SheetMesh, EndsWithAlphaNoughtAndNowhereElse) {
  for (const SheetMesh& mesh : kMeshes) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t a = mesh.indices[t + k], b = mesh.indices[t + (k + 1) % 3];
        // A fan's vertices in the middle are one place.
        const auto inMiddle = [&](std::uint32_t i) {
          const glm::dvec3 p = vertexOf(mesh, i).p;
          return p.x * p.x + p.y * p.y < 1e-6;
        };
        if (inMiddle(a)) a = 0;
        if (inMiddle(b)) b = 0;
        if (a > b) std::swap(a, b);
        ++edges[{a, b}];
      }
    int rim = 0;
    for (const auto& [edge, count] : edges) {
      if (edge.first == edge.second) continue;
      const bool out = vertexOf(mesh, edge.first).alpha == 0.0f && vertexOf(mesh, edge.second).alpha == 0.0f;
      if (count == 1) {
        EXPECT_TRUE(out);
        ++rim;
      } else {
        EXPECT_EQ(count, 2);
      }
    }
    EXPECT_GT(rim, 10);
    EXPECT_EQ(vertexOf(mesh, vertexCount(mesh) / 2).alpha, 1.0f);
  }
}

TEST(SheetMesh, TrianglesTurnCounterClockwiseFromBelow) {
  for (const SheetMesh& mesh : kMeshes)
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
      const glm::dvec3 a = vertexOf(mesh, mesh.indices[t]).p, b = vertexOf(mesh, mesh.indices[t + 1]).p,
                       c = vertexOf(mesh, mesh.indices[t + 2]).p;
      EXPECT_LT(glm::cross(b - a, c - a).z, 0.0) << t;  // from above: clockwise
    }
}

TEST(SheetMesh, HemisphereHasAVertexEveryTenDegrees) {
  const SheetMesh mesh = hemisphereMesh(2000.0);
  ASSERT_EQ(vertexCount(mesh), 10u * 36u);
  for (std::size_t i = 0; i < vertexCount(mesh); ++i) {
    const glm::dvec3 p = vertexOf(mesh, i).p;
    EXPECT_NEAR(glm::length(p), 2000.0, 1e-2);
    const double zenith = degrees(std::acos(p.z / 2000.0)), azimuth = degrees(std::atan2(p.y, p.x));
    EXPECT_NEAR(zenith, 10.0 * static_cast<double>(i / 36), 1e-2);
    if (i >= 36) {
      EXPECT_NEAR(std::remainder(azimuth, 10.0), 0.0, 1e-3);
    }
  }
}

// A pattern keeps its shapes on half a sphere: steps on it, down and around, are of one length in the pattern
// and square to each other. They grow from that of the zenith to twice it on the horizon.
TEST(SheetLook, WrapsAHemisphereWithoutShear) {
  scene::Sheet sheet;
  sheet.surface = scene::SheetSurface::kHemisphere;
  sheet.heightM = 2000.0;
  sheet.tileM = 500.0;
  const SheetMatter matter = matterOf(sheet, std::vector<float>(4, 0.5f), 3);
  const SheetLook look = lookOf(sheet, matter, 0.0, glm::dvec3(0.0), {0, 0, 1}, 1.0f);
  Sheet as{};
  as.offset = look.offset;
  as.perM = look.perM;
  as.wrap = look.wrap;
  const auto at = [&](double zenith, double azimuth) {
    return glm::dvec3(sheetCoordinate(as, glm::vec3(2000.0 * std::sin(zenith) * std::cos(azimuth),
                                                    2000.0 * std::sin(zenith) * std::sin(azimuth),
                                                    2000.0 * std::cos(zenith))) -
                      look.offset);
  };
  EXPECT_EQ(at(0.0, 0.0), glm::dvec3(0.0));
  constexpr double kStep = 0.02;
  for (const double zenith : {0.05, 0.3, 1.0, 0.5 * kPi})
    for (const double azimuth : {0.0, 1.0, 4.0}) {
      const glm::dvec3 down = at(zenith + kStep, azimuth) - at(zenith - kStep, azimuth);
      const glm::dvec3 around = at(zenith, azimuth + kStep) - at(zenith, azimuth - kStep);
      const double expected = 2.0 / (1.0 + std::cos(zenith)) * 4.0 * 2.0 * kStep;  // four tiles a radius
      EXPECT_NEAR(glm::length(down), expected, 1e-3 * expected);
      EXPECT_NEAR(glm::length(around), std::sin(zenith) * expected, 1e-3 * expected);
      EXPECT_NEAR(glm::dot(down, around), 0.0, 1e-3 * expected * expected);
      EXPECT_EQ(down.z, 0.0);
    }
}

TEST(SheetMesh, SkyPlaneKeepsItsHeightOverTheEarthAndReachesTheHorizon) {
  const double height = 3000.0;
  const SheetMesh mesh = skyPlaneMesh(height, kEarthRadiusM);
  double lowest = 90.0;
  for (std::size_t i = 0; i < vertexCount(mesh); ++i) {
    const Vertex v = vertexOf(mesh, i);
    const double r = glm::length(v.p + glm::dvec3(0, 0, kEarthRadiusM));
    EXPECT_NEAR(r - kEarthRadiusM, height, 1.0);
    if (v.alpha == 1.0f) lowest = std::min(lowest, degrees(std::asin(v.p.z / glm::length(v.p))));
  }
  EXPECT_LT(lowest, 0.0);
}

// Tarantilis: 1, .7, .3, 0 towards the horizon.
TEST(SheetMesh, DomeFadesInThreeRings) {
  const SheetMesh mesh = domeMesh(550.0, 5500.0, 20);
  const std::size_t n = vertexCount(mesh);
  EXPECT_EQ(n % 20, 0u);
  EXPECT_EQ(vertexOf(mesh, n - 1).alpha, 0.0f);
  EXPECT_EQ(vertexOf(mesh, n - 21).alpha, 0.3f);
  EXPECT_EQ(vertexOf(mesh, n - 41).alpha, 0.7f);
  EXPECT_EQ(vertexOf(mesh, n - 61).alpha, 1.0f);
  EXPECT_NEAR(vertexOf(mesh, 0).p.z, 550.0, 1e-3);
  EXPECT_NEAR(vertexOf(mesh, n - 20).p.x, 5500.0, 1e-2);
}

// Tarantilis's ring: from 1 on the inner vertices of his 4 x 4 to 0 on the outer ones.
TEST(SheetMesh, PlaneFadesOverItsOuterThird) {
  const SheetMesh mesh = planeMesh(1000.0);
  int whole = 0, fading = 0, rim = 0;
  for (std::size_t i = 0; i < vertexCount(mesh); ++i) {
    const Vertex v = vertexOf(mesh, i);
    const double out = std::max(std::abs(v.p.x), std::abs(v.p.y)) / 20000.0;
    if (out < 1.0 / 3.0) {
      EXPECT_EQ(v.alpha, 1.0f);
      ++whole;
    } else {
      EXPECT_NEAR(v.alpha, 1.5 * (1.0 - out), 1e-5);
      out == 1.0 ? ++rim : ++fading;
    }
    if (out == 1.0) {
      EXPECT_EQ(v.alpha, 0.0f);
    }
  }
  EXPECT_GT(whole, 100);
  EXPECT_GT(fading, 100);
  EXPECT_EQ(rim, 96);
}

// A turning wind moves the pattern by the integral of its velocity, an offset by tiles, and a tint is a tint.
TEST(SheetLook, FollowsDriftOffsetAndTint) {
  scene::Sheet sheet;
  sheet.windSpeedMps = 10.0;
  sheet.drift = {{.windDeg = 90.0, .coverOktas = 2.0, .periodH = 1.0}, 4, 5};
  sheet.oktas = 4.0;
  sheet.texels = 64;
  const Image<float> pattern = scene::flatPattern(sheet, 1);
  const SheetMatter matter = matterOf(sheet, pattern.data, 1);
  const auto look = [&](double seconds) {
    return lookOf(sheet, matterAt(sheet, matter, seconds), seconds, glm::dvec3(0.0), {0.0f, 0.0f, 1.0f},
                  0.001f);
  };
  const glm::dvec2 path =
      10.0 * scene::windPath(sheet.drift.drift, 4, sheet.windFromDeg, 1800.0) / sheet.tileM;
  EXPECT_NEAR(glm::fract(look(0.0).offset.x - path.x), look(1800.0).offset.x, 1e-5);
  EXPECT_NEAR(glm::fract(look(0.0).offset.y - path.y), look(1800.0).offset.y, 1e-5);
  EXPECT_GT(std::abs(path.y), 2e-3);
  // Cover as law: the threshold moves, smoothly, and is the described one at the scene's time.
  EXPECT_EQ(look(0.0).threshold, static_cast<float>(matter.law.threshold));
  EXPECT_NE(look(700.0).threshold, look(0.0).threshold);
  EXPECT_NEAR(look(700.0).threshold, look(701.0).threshold, 1e-3);

  const SheetLook before = look(0.0);
  sheet.offset = {0.25, 0.5, 0.0};
  sheet.colour = {1.0, 0.5, 0.25};
  EXPECT_NEAR(look(0.0).offset.x, glm::fract(before.offset.x + 0.25f), 1e-6f);
  EXPECT_NEAR(look(0.0).offset.y, glm::fract(before.offset.y + 0.5f), 1e-6f);
  EXPECT_EQ(look(0.0).tint, glm::vec3(1.0f, 0.5f, 0.25f));
}

SheetLook lookAt(double heightM, double seconds, glm::dvec3 eye = glm::dvec3(0.0)) {
  scene::Sheet sheet;
  sheet.heightM = heightM;
  sheet.windSpeedMps = 10.0;
  sheet.windFromDeg = 270.0;
  SheetMatter matter;
  matter.origin = {0.5, 0.5, 0.5};
  return lookOf(sheet, matter, seconds, eye, glm::vec3(0.6f, 0.0f, 0.8f), 0.001f);
}

// What stands over a place stays over it while the eye moves, and goes with the wind.
TEST(SheetLook, PatternIsFixedToTheMovingAir) {
  const SheetLook start = lookAt(1000.0, 0.0), moved = lookAt(1000.0, 60.0, {600.0, 0.0, 0.0});
  EXPECT_NEAR(start.offset.x, moved.offset.x, 1e-6f);
  EXPECT_NEAR(start.offset.y, moved.offset.y, 1e-6f);
  EXPECT_NEAR(lookAt(1000.0, 60.0).offset.x, start.offset.x - 600.0 / 12000.0, 1e-6);
}

// Two layers in the same wind: the angles by which they move past the zenith are as their heights inversely.
TEST(SheetLook, ParallaxGoesByHeight) {
  const auto angle = [](double heightM) {
    const double metres = (lookAt(heightM, 10.0).offset.x - lookAt(heightM, 0.0).offset.x) * 12000.0;
    return std::atan(-metres / heightM);
  };
  EXPECT_NEAR(std::tan(angle(500.0)) / std::tan(angle(2000.0)), 4.0, 0.01);
}

TEST(SheetLook, PositionsFarAwayLoseNoPrecision) {
  const SheetLook near = lookAt(1000.0, 0.0, {12000.0 * 3, 0.0, 0.0}),
                  far = lookAt(1000.0, 0.0, {12000.0 * 100000.0, 0.0, 0.0});
  EXPECT_NEAR(near.offset.x, far.offset.x, 1e-5f);
}

}  // namespace
}  // namespace welkin::shading
