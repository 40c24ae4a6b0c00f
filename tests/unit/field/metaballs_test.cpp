// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/metaballs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/field/metaball_cumulus.h"

namespace welkin::field {
namespace {

std::vector<Metaball> someBalls(int count, double side, double leastRadius, double greatestRadius,
                                std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<Metaball> balls;
  for (int i = 0; i < count; ++i)
    balls.push_back({side * glm::dvec3(random.uniform(), random.uniform(), random.uniform()),
                     leastRadius + (greatestRadius - leastRadius) * random.uniform(),
                     2.0 * random.uniform() - 0.5});
  return balls;
}

double plainSum(std::span<const Metaball> balls, const glm::dvec3& p) {
  double sum = 0.0;
  for (const Metaball& b : balls) {
    const glm::dvec3 d = p - b.centreM;
    sum += b.density * wyvill(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z) / b.radiusM);
  }
  return sum;
}

TEST(Metaballs, KernelIsWyvills) {
  for (const double a : {0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
    const double polynomial =
        1.0 - 22.0 / 9.0 * std::pow(a, 2) + 17.0 / 9.0 * std::pow(a, 4) - 4.0 / 9.0 * std::pow(a, 6);
    EXPECT_NEAR(wyvill(a), polynomial, 1e-15) << a;
  }
  EXPECT_EQ(wyvill(0.0), 1.0);
  EXPECT_NEAR(wyvill(0.5), 0.5, 1e-15);
  EXPECT_EQ(wyvill(1.0), 0.0);
  EXPECT_EQ(wyvill(1.5), 0.0);
  EXPECT_NEAR(wyvill(1.0 - 1e-4), 0.0, 1e-7) << "no slope at the surface";
}

TEST(Metaballs, IntegralOfTheKernelIsExact) {
  // Simpson's rule on 4 pi a^2 f(a), a polynomial of degree 8.
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double a = static_cast<double>(i) / kSteps;
    sum += (i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * a * a * wyvill(a);
  }
  EXPECT_NEAR(4.0 * std::numbers::pi * sum / (3.0 * kSteps), kWyvillIntegral, 1e-12);
}

// From outside, from within and past a ball, and away from it.
TEST(Metaballs, ColumnIsTheIntegralAlongARay) {
  const Metaball ball{{10.0, -20.0, 30.0}, 8.0, 0.3};
  const glm::dvec3 direction = glm::normalize(glm::dvec3(1.0, 2.0, -2.0));
  for (const double aside : {0.0, 3.0, 7.5, 9.0})
    for (const double start : {-50.0, -2.0, 5.0, 20.0}) {
      const glm::dvec3 across = glm::normalize(glm::dvec3(2.0, 1.0, 2.0));  // square to it
      const glm::dvec3 from = ball.centreM + start * direction + aside * across;
      constexpr int kSteps = 20000;
      constexpr double kStepM = 100.0 / kSteps;
      double sum = 0.0;
      for (int i = 0; i < kSteps; ++i)
        sum += kStepM * ball.density *
               wyvill(glm::distance(from + (i + 0.5) * kStepM * direction, ball.centreM) / ball.radiusM);
      EXPECT_NEAR(columnAlong(ball, from, direction), sum, 1e-5) << aside << " " << start;
    }
}

TEST(Metaballs, FieldIntegratesToTheAnalyticValue) {
  const std::vector<Metaball> balls = {
      {{0, 0, 0}, 40, 1.0}, {{30, -20, 10}, 25, -0.4}, {{-35, 5, 0}, 33, 0.7}};
  const Box box = boundsOf(balls);
  const double step = 2.0;
  const glm::ivec3 n = glm::ivec3((box.high - box.low) / step) + 2;
  const Volume<float> volume = rasterise(balls, {n.x, n.y, n.z, glm::dvec3(step), box.low});
  double sum = 0.0;
  for (const float v : volume.data) sum += static_cast<double>(v);
  EXPECT_NEAR(sum * step * step * step / integralOf(balls), 1.0, 1e-4);
}

TEST(Metaballs, FieldIsTheSum) {
  for (const int count : {1, 7, 3000}) {
    const std::vector<Metaball> balls = someBalls(count, 1000, count > 100 ? 5 : 100, 250);
    const MetaballField field(balls);
    Random random(3);
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 p = 1400.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 200.0;
      EXPECT_NEAR(field(p), plainSum(balls, p), 1e-11 * count);
    }
    EXPECT_EQ(field({1e9, 0, 0}), 0.0);
    EXPECT_EQ(field(glm::dvec3(std::numeric_limits<double>::quiet_NaN())), 0.0);
  }
  EXPECT_EQ(MetaballField()({0, 0, 0}), 0.0);
  EXPECT_EQ(MetaballField(std::vector<Metaball>())({0, 0, 0}), 0.0);
}

// Sizes that are no multiple of a vector, balls that cross all faces, oblong voxels, one ball far larger than
// the volume and one between voxels.
TEST(Metaballs, RasterIsTheFieldAtTheCentres) {
  std::vector<Metaball> balls = someBalls(60, 400, 10, 90);
  balls.push_back({{200, 200, 200}, 5000, 0.3});
  balls.push_back({{103, 107, 209}, 0.5, 1.0});
  balls.push_back({{0, 0, 1e7}, 100, 1.0});
  for (const int nx : {1, 15, 37}) {
    const VoxelFrame frame{nx, 19, 23, {11, 20, 17}, {5, 10, -3}};
    const Volume<float> volume = rasterise(balls, frame);
    for (int z = 0; z < frame.nz; ++z)
      for (int y = 0; y < frame.ny; ++y)
        for (int x = 0; x < frame.nx; ++x) {
          const glm::dvec3 p = frame.firstVoxelM + frame.voxelSizeM * glm::dvec3(x, y, z);
          ASSERT_NEAR(static_cast<double>(volume.at(x, y, z)), plainSum(balls, p), 3e-6)
              << x << " " << y << " " << z;
        }
  }
}

TEST(Metaballs, RasterIsTheSameInAnyNumberOfThreads) {
  const std::vector<Metaball> balls = someBalls(300, 400, 10, 90);
  const VoxelFrame frame{41, 40, 39, glm::dvec3(10), glm::dvec3(0)};
  setThreadCount(1);
  const Volume<float> one = rasterise(balls, frame);
  setThreadCount(5);
  const Volume<float> five = rasterise(balls, frame);
  setThreadCount(0);
  EXPECT_EQ(one.data, five.data);
}

TEST(Metaballs, WhatIsNoBallIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Metaball& bad : {Metaball{{nan, 0, 0}, 1, 1}, Metaball{{0, 0, 0}, 0, 1},
                              Metaball{{0, 0, 0}, -1, 1}, Metaball{{0, 0, 0}, 1, nan}}) {
    const std::vector<Metaball> balls = {{{0, 0, 0}, 1, 1}, bad};
    EXPECT_THROW(MetaballField{balls}, ParameterError);
    EXPECT_THROW(rasterise(balls, {2, 2, 2}), ParameterError);
  }
}

TEST(MetaballCumulus, StandsOnItsBaseAndIsAboutAsDenseEverywhere) {
  const CumulusParams params{.widthM = 1400, .heightM = 1000};
  const std::vector<Metaball> balls = cumulusMetaballs(params, 0.8);
  EXPECT_GT(balls.size(), 100U);
  EXPECT_EQ(balls, cumulusMetaballs(params, 0.8));
  EXPECT_NE(balls, cumulusMetaballs({.seed = 1, .widthM = 1400, .heightM = 1000}, 0.8));
  const MetaballField field(balls);
  for (double x = -700; x <= 700; x += 50)
    for (double y = -700; y <= 700; y += 50) EXPECT_LT(field({x, y, -100}), 0.02) << x << " " << y;
  std::vector<double> atCentres;
  for (const Metaball& b : balls) {
    EXPECT_GT(b.density, 0.0);
    atCentres.push_back(field(b.centreM));
  }
  std::sort(atCentres.begin(), atCentres.end());
  EXPECT_NEAR(atCentres[atCentres.size() / 2], 0.8, 0.08);
  EXPECT_LT(atCentres.back(), 1.6) << "where many balls overlap it must not be many times denser";
}

}  // namespace
}  // namespace welkin::field
