// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cloud_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/field/cumulus_tower.h"

namespace welkin::field {
namespace {

std::int64_t cloudVoxels(const Volume<float>& map) {
  return std::count_if(map.data.begin(), map.data.end(), [](float d) { return d > 0; });
}

Volume<float> exampleMap(const CloudMapParams& p) {
  const Ellipsoid e = centredEllipsoid(p);
  return cloudMap(p, {&e, 1});
}

// The paper says 11,000 voxels for Z = 4 and s = 0.5, without the size of its box.
TEST(CloudMap, ThePapersExampleHasAbout11800Voxels) {
  const Volume<float> map = exampleMap({});
  EXPECT_EQ(map.nx, 48);
  EXPECT_EQ(map.ny, 36);
  EXPECT_EQ(map.nz, 24);
  EXPECT_NEAR(static_cast<double>(cloudVoxels(map)), 11800, 100);
}

// Voxel by voxel from the formulas, with the point functions.
TEST(CloudMap, IsThePapersFormula) {
  const CloudMapParams p{.threshold = 0.05, .dynamics = 0.5};
  const Ellipsoid ellipsoids[] = {{{-100, 20, 200}, {300, 250, 180}, {10, 20, 30}},
                                  {{150, 0, 260}, {200, 100, 120}, {0, -30, 70}}};
  const Volume<float> map = cloudMap(p, ellipsoids);
  const noise::Value noise;
  const EllipsoidForm a(ellipsoids[0]), b(ellipsoids[1]);
  for (int z = 0; z < 24; ++z)
    for (int y = 0; y < 36; ++y)
      for (int x = 0; x < 48; ++x) {
        double sum = 0;
        for (int o = 0; o < 4; ++o) {
          const double f = (1 << o) / 12.0;
          sum += std::pow(0.5, o) * noise((x + 0.5) * f, (y + 0.5) * f, (z + 0.5) * f);
        }
        const glm::dvec3 at = firstVoxelM(p) + 20.0 * glm::dvec3(x, y, z);
        const double united = 1.0 - (1.0 - std::max(0.0, a.q(at))) * (1.0 - std::max(0.0, b.q(at)));
        const double density = united * std::abs(sum);
        if (std::abs(density - 0.05) < 1e-5) continue;
        ASSERT_NEAR(map.at(x, y, z), density >= 0.05 ? 0.5 * density : 0.0, 2e-6);
      }
}

TEST(CloudMap, IsTheSameInAnyNumberOfThreads) {
  CloudMapParams p{.nx = 40, .ny = 40, .nz = 37, .voxelM = 30, .threshold = 0.1};
  p.noise = {.kind = MapNoiseKind::kPerlin, .fold = MapFold::kShifted, .seed = 3};
  const std::vector<Ellipsoid> tower = cumulusTower({.widthM = 1100, .heightM = 1000});
  setThreadCount(1);
  const Volume<float> one = cloudMap(p, tower);
  setThreadCount(5);
  const Volume<float> five = cloudMap(p, tower);
  setThreadCount(0);
  EXPECT_EQ(one.data, five.data);
}

TEST(CloudMap, WithoutNoiseItIsQ) {
  CloudMapParams p{.nx = 21, .ny = 21, .nz = 21, .voxelM = 10, .threshold = 0.0};
  p.noise.octaves = 0;
  const Ellipsoid ball{{0, 0, 105}, glm::dvec3(100), {}};
  const Volume<float> map = cloudMap(p, {&ball, 1});
  EXPECT_FLOAT_EQ(map.at(10, 10, 10), 1.0f);
  EXPECT_FLOAT_EQ(map.at(15, 10, 10), 0.75f);
  EXPECT_FLOAT_EQ(map.at(10, 10, 0), 0.0f);
  // 4/3 pi 10^3 voxels.
  EXPECT_NEAR(static_cast<double>(cloudVoxels(map)), 4188.8, 60);
}

TEST(CloudMap, HasAFlatBase) {
  CloudMapParams p{.nx = 32, .ny = 32, .nz = 32, .voxelM = 40, .threshold = 0.05, .baseM = 200.0};
  p.noise.octaves = 0;
  const Volume<float> map = cloudMap(p, cumulusTower({.widthM = 1200, .heightM = 1200}));
  int below = 0, atBase = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      for (int z = 0; z < 5; ++z) below += map.at(x, y, z) > 0;
      atBase += map.at(x, y, 5) > 0;
    }
  EXPECT_EQ(below, 0);
  EXPECT_GT(atBase, 200);
}

TEST(CloudMap, EmptyCloudsAreErrors) {
  EXPECT_THROW(exampleMap({.threshold = 5.0}), ParameterError);
  EXPECT_THROW(cloudMap({}, {}), ParameterError);
  const Ellipsoid far{{1e5, 0, 0}, glm::dvec3(100), {}};
  EXPECT_THROW(cloudMap({}, {&far, 1}), ParameterError);
  EXPECT_THROW(exampleMap({.nx = 0}), ParameterError);
  EXPECT_THROW(exampleMap({.nx = 60000, .ny = 60000, .nz = 60000}), ParameterError);
}

TEST(CloudMap, StopsWhenToldTo) {
  const CloudMapParams p{};
  const Ellipsoid e = centredEllipsoid(p);
  EXPECT_THROW(cloudMap(p, {&e, 1}, [](double) { throw Interrupted(); }), Interrupted);
}

}  // namespace
}  // namespace welkin::field
