// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/cellular.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "welkin/core/random.h"

namespace welkin::noise {
namespace {

TEST(Cellular, TilesWithAnyPeriod) {
  Random random(3);
  for (const glm::ivec3 period : {glm::ivec3(1, 1, 1), glm::ivec3(2, 3, 5), glm::ivec3(17, 9, 4)}) {
    const Cellular cells(5, period);
    for (int i = 0; i < 200; ++i) {
      const float x = static_cast<float>(random.below(64 * period.x)) / 64,
                  y = static_cast<float>(random.below(64 * period.y)) / 64,
                  z = static_cast<float>(random.below(64 * period.z)) / 64;
      EXPECT_FLOAT_EQ(cells.f1(x, y, z),
                      cells.f1(x + static_cast<float>(period.x), y, z - static_cast<float>(period.z)));
      EXPECT_FLOAT_EQ(cells.f1(x, y), cells.f1(x, y + static_cast<float>(period.y)));
    }
  }
}

// A distance function: it cannot change faster than position.
TEST(Cellular, ChangesNoFasterThanPosition) {
  const Cellular cells(9, {6, 6, 6});
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const float x = 6 * random.uniform(), y = 6 * random.uniform(), z = 6 * random.uniform();
    EXPECT_LE(std::abs(cells.f1(x, y, z) - cells.f1(x + 0.01f, y, z)), 0.0101f);
  }
}

TEST(Cellular, RowsAreTheSameDistances) {
  for (const int cellsAcross : {1, 5, 40}) {
    const Cellular cells(6, glm::ivec3(cellsAcross));
    std::vector<float> row(100);
    const float step = static_cast<float>(cellsAcross) / 100.0f;
    auto x = [&](int i) { return (static_cast<float>(i) + 0.5f) * step; };
    for (const float place : {0.1f, 0.5f, 0.97f}) {
      const float y = place * static_cast<float>(cellsAcross), z = 0.4f * y;
      cells.f1Row(row, step, y, z);
      for (int i = 0; i < 100; ++i) EXPECT_NEAR(row[i], cells.f1(x(i), y, z), 1e-5f);
      cells.f1Row(row, step, y);
      for (int i = 0; i < 100; ++i) EXPECT_NEAR(row[i], cells.f1(x(i), y), 1e-5f);
    }
  }
}

TEST(Cellular, IsZeroSomewhereInEveryCell) {
  const Cellular cells(21, {4, 4, 4});
  for (int cell = 0; cell < 4; ++cell) {
    float least = 1.0f;
    for (int k = 0; k < 24; ++k)
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i)
          least = std::min(least, cells.f1(static_cast<float>(cell) + static_cast<float>(i) / 24,
                                           static_cast<float>(j) / 24, static_cast<float>(k) / 24));
    EXPECT_LT(least, 0.05f) << "cell " << cell;
  }
}

}  // namespace
}  // namespace welkin::noise
