// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/perlin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "welkin/core/random.h"

namespace welkin::noise {
namespace {

// Values of Perlin's own reference program.
TEST(Perlin, ReproducesThePublishedValues) {
  const Perlin perlin;
  EXPECT_NEAR(perlin(3.14, 42, 7), 0.13691995878400012, 1e-15);
  EXPECT_NEAR(perlin(-4.20, 10, 6), 0.14208000000000043, 1e-15);
  EXPECT_DOUBLE_EQ(perlin(0.5, 0.5, 0.5), -0.25);
  EXPECT_DOUBLE_EQ(perlin(17, -3, 255), 0.0);
}

TEST(Perlin, IsTheSameFarFromTheOrigin) {
  const Perlin perlin;
  // 256 * 2^22 cells away, where floats cannot even count cells.
  const double far = 256.0 * 4194304.0;
  EXPECT_NEAR(perlin(3.140625 + far, 42.25 - far, 7.5), perlin(3.140625, 42.25, 7.5), 1e-12);
}

TEST(Perlin, HasTheKnownSpread) {
  const Perlin perlin(7);
  Random random(1);
  double sum = 0, squares = 0, greatest = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double v = perlin(random.uniform() * 256, random.uniform() * 256, random.uniform() * 256);
    sum += v;
    squares += v * v;
    greatest = std::max(greatest, std::abs(v));
  }
  EXPECT_NEAR(sum / n, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / n), 0.27, 0.01);
  EXPECT_LT(greatest, 1.04);
}

TEST(Perlin, TilesWithAnyPeriod) {
  const Perlin perlin(11);
  Random random(2);
  for (const glm::ivec3 period : {glm::ivec3(1, 1, 1), glm::ivec3(3, 5, 7), glm::ivec3(300, 257, 511)}) {
    for (int i = 0; i < 200; ++i) {
      // Multiples of 1/64, so that adding the period is exact.
      const float x = static_cast<float>(random.below(64 * period.x)) / 64,
                  y = static_cast<float>(random.below(64 * period.y)) / 64,
                  z = static_cast<float>(random.below(64 * period.z)) / 64;
      const float here = perlin.periodic(x, y, z, period);
      EXPECT_EQ(here, perlin.periodic(x + static_cast<float>(period.x), y, z, period));
      EXPECT_EQ(here, perlin.periodic(x, y - static_cast<float>(period.y), z, period));
      EXPECT_EQ(here, perlin.periodic(x, y, z + static_cast<float>(period.z), period));
    }
  }
}

TEST(Perlin, HasNoSeamWhereItTiles) {
  const Perlin perlin(13);
  // Either side of the border must agree as closely as neighbours do anywhere.
  const float step = 1.0f / 1024;
  for (int i = 0; i < 100; ++i) {
    const float y = 0.37f + static_cast<float>(i) * 0.05f;
    const float inside = perlin.periodic(5.0f - step, y, 0.3f, {5, 5, 5});
    const float outside = perlin.periodic(0.0f + step, y, 0.3f, {5, 5, 5});
    EXPECT_NEAR(inside, outside, 0.01f);
  }
}

TEST(Perlin, RowsAreTheSameNoise) {
  const Perlin perlin(17);
  for (const glm::ivec3 period :
       {glm::ivec3(1, 2, 3), glm::ivec3(5, 5, 5), glm::ivec3(40, 40, 40), glm::ivec3(300, 300, 256)}) {
    std::vector<float> row(128, 0.25f);
    const float step = static_cast<float>(period.x) / 128.0f;
    for (const float y : {0.3f, 1.9f})
      for (const float z : {0.5f, 2.2f}) {
        std::fill(row.begin(), row.end(), 0.25f);
        perlin.addRow(row, 3.0f, step, y, z, period);
        for (int i = 0; i < 128; ++i)
          EXPECT_NEAR(row[i],
                      0.25f + 3.0f * perlin.periodic((static_cast<float>(i) + 0.5f) * step, y, z, period),
                      1e-5f);
      }
  }
}

TEST(Perlin, SeedsDiffer) {
  EXPECT_NE(Perlin(1)(0.3, 0.4, 0.5), Perlin(2)(0.3, 0.4, 0.5));
  EXPECT_EQ(Perlin(1)(0.3, 0.4, 0.5), Perlin(1)(0.3, 0.4, 0.5));
}

}  // namespace
}  // namespace welkin::noise
