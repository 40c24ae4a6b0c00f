// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/jitter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace welkin::render {
namespace {

TEST(Jitter, FirstSampleIsThePixelsMiddleAndAllLieInIt) {
  EXPECT_EQ(jitterPx(0), glm::vec2(0.0f));
  for (int i = 0; i < 1000; ++i) {
    EXPECT_GE(std::min(jitterPx(i).x, jitterPx(i).y), -0.5f) << i;
    EXPECT_LT(std::max(jitterPx(i).x, jitterPx(i).y), 0.5f) << i;
  }
}

TEST(Jitter, StepsOfTwoFourAndSoOnAreEquidistantEachWay) {
  for (int count = 1; count <= 256; count *= 2) {
    std::vector<float> x, y;
    for (int i = 0; i < count; ++i) {
      x.push_back(jitterStep(i).x);
      y.push_back(jitterStep(i).y);
    }
    std::ranges::sort(x);
    std::ranges::sort(y);
    for (int i = 0; i < count; ++i) {
      const float expected = static_cast<float>(i) / static_cast<float>(count);
      EXPECT_EQ(x[static_cast<std::size_t>(i)], expected) << count;
      EXPECT_EQ(y[static_cast<std::size_t>(i)], expected) << count;
    }
  }
}

// Were both the same, light along the ray and towards the sun would be sampled on a diagonal alone: of
// sixteen there is one in every sixteenth of the square, four by four.
TEST(Jitter, StepsFillTheSquare) {
  std::vector<int> cells(16);
  for (int i = 0; i < 16; ++i) {
    const glm::vec2 at = 4.0f * jitterStep(i);
    ++cells[static_cast<std::size_t>(4 * static_cast<int>(at.y) + static_cast<int>(at.x))];
  }
  EXPECT_EQ(std::ranges::count(cells, 1), 16);
}

}  // namespace
}  // namespace welkin::render
