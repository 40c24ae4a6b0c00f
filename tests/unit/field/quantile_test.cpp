// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/quantile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "welkin/core/random.h"
#include "welkin/field/condensation.h"

namespace welkin::field {
namespace {

std::vector<float> bellShaped(int n) {
  Random random(4);
  std::vector<float> v(n);
  for (float& x : v) {
    x = -2.0f;
    for (int i = 0; i < 4; ++i) x += random.uniform();
  }
  return v;
}

std::int64_t above(const std::vector<float>& v, double threshold) {
  return std::count_if(v.begin(), v.end(), [&](float x) { return static_cast<double>(x) > threshold; });
}

TEST(Quantile, IsExactToASample) {
  for (const int n : {1, 2, 3, 1000, 65537}) {
    const std::vector<float> v = bellShaped(n);
    std::vector<float> distinct = v;
    std::sort(distinct.begin(), distinct.end());
    const bool ties = std::adjacent_find(distinct.begin(), distinct.end()) != distinct.end();
    for (const double fraction : {0.0, 0.001, 0.25, 0.5, 5.0 / 8, 0.9999, 1.0})
      EXPECT_NEAR(above(v, quantileAbove(v, fraction)), std::llround(fraction * n), ties ? 1 : 0);
  }
}

TEST(Quantile, EqualSamplesStayTogether) {
  std::vector<float> v(1000, 0.5f);
  EXPECT_EQ(above(v, quantileAbove(v, 0.4)), 0);
  EXPECT_EQ(above(v, quantileAbove(v, 0.6)), 1000);
  std::fill(v.begin(), v.begin() + 300, -0.0f);
  std::fill(v.begin(), v.begin() + 200, 0.0f);
  EXPECT_EQ(above(v, quantileAbove(v, 0.7)), 700);
  EXPECT_EQ(above(v, quantileAbove(v, 0.8)), 700);
  EXPECT_EQ(above(v, quantileAbove(v, 0.95)), 1000);
}

TEST(Quantile, NeighbouringFloatsAreToldApart) {
  const float a = 0.3f, b = std::nextafter(a, 1.0f);
  EXPECT_EQ(above({a, b, a, b}, quantileAbove(std::vector<float>{a, b, a, b}, 0.5)), 2);
}

TEST(Quantile, CountsInPiecesAndFromSeveralThreads) {
  const std::vector<float> v = bellShaped(10000);
  SampleQuantile one(0.3), other(0.3);
  const std::span<const float> all(v);
  one.add(all.subspan(5000));
  other.add(all.first(5000));
  one.merge(other);
  one.nextPass();
  SampleQuantile second = one;  // as far as the first pass came
  second.add(all.first(2000));
  one.add(all.subspan(2000));
  one.merge(second);
  EXPECT_EQ(one.threshold(), quantileAbove(v, 0.3));
}

// The asked-for fraction of 8-bit texels is not zero, to the texel.
TEST(Quantile, CoverOfATextureIsTheOneAskedFor) {
  std::vector<float> noise = bellShaped(200000);
  for (float& n : noise) n = 0.5f + 0.25f * n;
  for (const double cover : {0.1, 0.375, 0.875}) {
    const Condensation laws[] = {thesisTexture(0, 0.96), thesisShader(0, 1e-3, 0.7), pallister(0, 3.0)};
    for (const Condensation& law : laws) {
      const double quantile = quantileAbove(noise, cover);
      std::vector<float> opacity = noise;
      withCover(law, quantile, 0.5 / 255).apply(opacity);
      const auto covered =
          std::count_if(opacity.begin(), opacity.end(), [](float x) { return std::lround(x * 255.0f) > 0; });
      EXPECT_NEAR(static_cast<double>(covered), cover * 200000, 1.0);
    }
  }
}

// Equal values become cloud together or not at all, whichever is nearer, in integers as in floats.
TEST(Quantile, CoverOfEqualValues) {
  std::vector<float> noise(1000, 1.0f);
  for (std::size_t i = 0; i < 840; ++i) noise[i] = static_cast<float>(i) / 1000.0f;
  const std::pair<double, int> wanted[] = {{0.0, 0},    {0.05, 0},  {0.1, 160},
                                           {0.16, 160}, {0.3, 300}, {1.0, 1000}};
  for (const double visible : {0.0, 0.5 / 255, 0.5 / 65535})
    for (const auto& [cover, texels] : wanted) {
      std::vector<float> opacity = noise;
      withCover(thesisTexture(0, 0.96), quantileAbove(noise, cover), visible).apply(opacity);
      const auto least = static_cast<float>(visible);
      EXPECT_EQ(std::count_if(opacity.begin(), opacity.end(),
                              [&](float x) { return least > 0.0f ? x >= least : x > 0.0f; }),
                texels)
          << cover << " " << visible;
    }
}

}  // namespace
}  // namespace welkin::field
