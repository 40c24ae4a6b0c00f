// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/metaball_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace welkin::field {
namespace {

std::vector<Metaball> column(int count) {
  std::vector<Metaball> balls;
  for (int i = 0; i < count; ++i) balls.push_back({{0, 0, 10.0 * (i % 100)}, 100, 0.5});
  return balls;
}

double volumeOf(const Metaball& b) {
  return b.density == 0.0 ? 0.0 : b.radiusM * b.radiusM * b.radiusM;
}

TEST(MetaballMotion, WithoutALifeTheCloudDriftsAndKeepsItsShape) {
  const std::vector<Metaball> balls = column(50);
  const MetaballMotion motion{.windMps = {10, -5, 0}, .shearPerS = {0.01, 0, 0}};
  EXPECT_EQ(ballsAt(balls, motion, 0.0), balls);
  const std::vector<Metaball> later = ballsAt(balls, motion, 120.0);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    EXPECT_EQ(later[i].centreM, balls[i].centreM + glm::dvec3(1200, -600, 0));
    EXPECT_EQ(later[i].radiusM, balls[i].radiusM);
    EXPECT_EQ(later[i].density, balls[i].density);
  }
}

// Each ball has the wind of its own height while it lives.
TEST(MetaballMotion, EachHeightHasItsWind) {
  const std::vector<Metaball> balls = column(100);
  const MetaballMotion motion{
      .windMps = {8, 3, 0}, .shearPerS = {0.01, -0.02, 0}, .referenceM = 200, .lifeS = 1000, .fade = 0.25};
  const std::vector<Metaball> now = ballsAt(balls, motion, 500.0), later = ballsAt(balls, motion, 501.0);
  int alive = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const glm::dvec3 moved = later[i].centreM - now[i].centreM;
    const double above = balls[i].centreM.z - 200.0;
    if (std::abs(moved.x - 8.0) > 0.01 * 800.0 + 1e-9) continue;  // born again in this second
    EXPECT_NEAR(moved.x, 8.0 + 0.01 * above, 1e-9);
    EXPECT_NEAR(moved.y, 3.0 - 0.02 * above, 1e-9);
    ++alive;
  }
  EXPECT_GT(alive, 95);
}

// The expected volume of every ball is its own, at any time.
TEST(MetaballMotion, GrowthAndDecayKeepTheMean) {
  const std::vector<Metaball> balls = column(20000);
  for (const double fade : {0.1, 0.3, 0.5})
    for (const double t : {0.0, 77.0, 123456.0}) {
      double sum = 0.0, least = 1e30, most = 0.0;
      for (const Metaball& b : ballsAt(balls, {.lifeS = 600, .fade = fade}, t)) {
        sum += volumeOf(b) / 1e6;
        least = std::min(least, volumeOf(b) / 1e6);
        most = std::max(most, volumeOf(b) / 1e6);
      }
      EXPECT_NEAR(sum / static_cast<double>(balls.size()), 1.0, 0.01) << fade << " " << t;
      EXPECT_LT(least, 0.01);
      EXPECT_NEAR(most, 1.0 / (1.0 - fade), 1e-3);
    }
}

TEST(MetaballMotion, IsContinuousAndAgainAndAgainNothingIsLeftOfABall) {
  const std::vector<Metaball> balls = column(20);
  const MetaballMotion motion{
      .windMps = {8, 0, 0}, .shearPerS = {0.01, 0.002, 0}, .referenceM = 100, .lifeS = 300, .fade = 0.25};
  std::vector<int> births(balls.size(), 0);
  std::vector<Metaball> before = ballsAt(balls, motion, 0.0);
  for (int step = 1; step <= 2400; ++step) {
    const std::vector<Metaball> now = ballsAt(balls, motion, 0.5 * step);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      EXPECT_LT(std::abs(volumeOf(now[i]) - volumeOf(before[i])), 0.04e6);
      const double jump = std::abs(now[i].centreM.x - before[i].centreM.x);
      if (jump > 0.5 * (8 + 0.01 * 1000) + 1e-9) {  // reborn: then it must be next to nothing
        ++births[i];
        EXPECT_LT(volumeOf(now[i]), 0.01e6);
        EXPECT_LT(volumeOf(before[i]), 0.01e6);
      }
      // Never farther from its place in the cloud than half of the longest life takes it.
      const double height = balls[i].centreM.z - 100;
      EXPECT_LE(std::abs(now[i].centreM.x - 8 * 0.5 * step), 0.5 * 390 * 0.01 * std::abs(height) + 1e-9);
    }
    before = now;
  }
  EXPECT_GE(*std::max_element(births.begin(), births.end()), 3);
}

TEST(MetaballMotion, SeedsDiffer) {
  const std::vector<Metaball> balls = column(10);
  EXPECT_EQ(ballsAt(balls, {.lifeS = 100}, 5.0), ballsAt(balls, {.lifeS = 100}, 5.0));
  EXPECT_NE(ballsAt(balls, {.lifeS = 100}, 5.0), ballsAt(balls, {.lifeS = 100, .seed = 1}, 5.0));
}

}  // namespace
}  // namespace welkin::field
