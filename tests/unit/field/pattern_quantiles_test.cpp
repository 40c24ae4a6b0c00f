// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/pattern_quantiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "welkin/core/random.h"

namespace welkin::field {
namespace {

TEST(PatternQuantiles, SoMuchIsAbove) {
  Random random(7);
  std::vector<float> pattern(100000);
  for (float& p : pattern) p = static_cast<float>(random.uniform() * random.uniform());
  const PatternQuantiles table(pattern);
  for (const double fraction : {0.0, 0.001, 0.125, 0.3337, 0.5, 0.9, 1.0}) {
    const double value = table.above(fraction);
    const auto above = std::count_if(pattern.begin(), pattern.end(), [&](float p) { return p > value; });
    EXPECT_NEAR(static_cast<double>(above) / 1e5, fraction, 0.002) << fraction;
  }
}

TEST(PatternQuantiles, FallsFromTheGreatestToTheLeast) {
  const std::vector<float> pattern = {0.25f, 0.25f, 0.25f, 0.75f};  // many equal values
  const PatternQuantiles table(pattern);
  EXPECT_EQ(table.above(0.0), 0.75f);
  EXPECT_EQ(table.above(1.0), 0.25f);
  EXPECT_EQ(table.above(-3.0), 0.75f);
  for (double f = 0.0; f < 1.0; f += 0.01) EXPECT_GE(table.above(f), table.above(f + 0.01));
  EXPECT_EQ(PatternQuantiles().above(0.4), 0.0);
}

}  // namespace
}  // namespace welkin::field
