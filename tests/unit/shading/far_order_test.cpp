// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/far_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/core/random.h"

namespace welkin::shading {
namespace {

constexpr std::size_t kCount = 10000;

// A cloud 400 m wide.
std::vector<glm::dvec3> someBalls() {
  Random random(3);
  std::vector<glm::dvec3> balls(kCount);
  for (glm::dvec3& b : balls)
    for (int a = 0; a < 3; ++a) b[a] = 400.0 * random.uniform();
  return balls;
}

std::vector<float> distancesFrom(const glm::dvec3& eye, const std::vector<glm::dvec3>& balls) {
  std::vector<float> distances;
  distances.reserve(balls.size());
  for (const glm::dvec3& b : balls) distances.push_back(static_cast<float>(glm::length(b - eye)));
  return distances;
}

void expectSorted(std::span<const std::uint32_t> order, const std::vector<float>& distances) {
  ASSERT_EQ(order.size(), distances.size());
  std::vector<bool> seen(order.size(), false);
  for (const std::uint32_t i : order) seen[i] = true;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    const float farther = distances[order[i - 1]], nearer = distances[order[i]];
    EXPECT_TRUE(farther > nearer || (farther == nearer && order[i - 1] < order[i])) << i;
  }
}

// At 1 km, in steps of a metre, as at 10 m/s and 10 frames a second.
TEST(FarOrder, SmallStepsCostMuchLessThanAFreshSort) {
  const std::vector<glm::dvec3> balls = someBalls();
  FarOrder order;
  glm::dvec3 eye(200.0, -1000.0, 200.0);
  expectSorted(order.sort(distancesFrom(eye, balls)), distancesFrom(eye, balls));
  EXPECT_TRUE(order.isFresh());
  const std::size_t fresh = order.comparisons();
  EXPECT_GT(fresh, kCount * 10);
  for (const glm::dvec3 step : {glm::dvec3(0, 1, 0), glm::dvec3(0.5, 0.5, 0), glm::dvec3(0, -1, 0)}) {
    eye += step;
    const std::vector<float> distances = distancesFrom(eye, balls);
    expectSorted(order.sort(distances), distances);
    EXPECT_FALSE(order.isFresh());
    EXPECT_LT(order.comparisons(), fresh / 3);
  }
  // At rest: each with the one before it.
  order.sort(distancesFrom(eye, balls));
  EXPECT_EQ(order.comparisons(), kCount - 1);
}

// A jump costs no more than little above a fresh sort, and another number of balls is one.
TEST(FarOrder, BeginsAnewWhereMuchHasMoved) {
  std::vector<glm::dvec3> balls = someBalls();
  FarOrder order;
  order.sort(distancesFrom({200.0, -1000.0, 200.0}, balls));
  const std::size_t fresh = order.comparisons();
  const std::vector<float> behind = distancesFrom({200.0, 1400.0, 200.0}, balls);
  expectSorted(order.sort(behind), behind);
  EXPECT_TRUE(order.isFresh());
  EXPECT_LT(order.comparisons(), 4 * fresh);
  balls.resize(kCount / 2);
  const std::vector<float> fewer = distancesFrom({200.0, 1400.0, 200.0}, balls);
  expectSorted(order.sort(fewer), fewer);
  EXPECT_TRUE(order.isFresh());
}

TEST(FarOrder, EqualDistancesComeByNumberHoweverTheyWereFound) {
  const std::vector<float> equal = {2, 3, 2, 3, 2}, others = {1, 2, 3, 4, 5};
  FarOrder order;
  order.sort(others);
  const auto found = order.sort(equal);
  EXPECT_FALSE(order.isFresh());
  EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()),
            (std::vector<std::uint32_t>{1, 3, 0, 2, 4}));
  EXPECT_TRUE(order.sort({}).empty());
}

}  // namespace
}  // namespace welkin::shading
