// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/picture_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "welkin/core/error.h"

namespace welkin::reference {
namespace {

Image<float> greys(std::vector<float> values) {
  Image<float> p(static_cast<int>(values.size()), 1, 1);
  p.data = std::move(values);
  return p;
}

TEST(PictureError, IsRelativeToTheTruth) {
  const PictureError e = errorOf(greys({110.0f, 150.0f, 400.0f}), greys({100.0f, 200.0f, 400.0f}));
  EXPECT_NEAR(e.mean, 220.0, 1e-9);
  EXPECT_NEAR(e.meanOfTruth, 700.0 / 3.0, 1e-9);
  EXPECT_NEAR(e.bias, 660.0 / 700.0 - 1.0, 1e-9);
  EXPECT_NEAR(e.relative, (0.1 + 0.25) / 3.0, 1e-6);
  EXPECT_NEAR(e.relativeRms, std::sqrt((0.01 + 0.0625) / 3.0), 1e-6);
  EXPECT_NEAR(e.largest, 0.25, 1e-6);
}

TEST(PictureError, WeighsPixels) {
  const std::vector<float> weights = {1.0f, 0.0f, 3.0f};
  const PictureError e = errorOf(greys({110.0f, 1e9f, 400.0f}), greys({100.0f, 200.0f, 400.0f}), weights);
  EXPECT_NEAR(e.relative, 0.1 / 4.0, 1e-6);
  EXPECT_NEAR(e.bias, 10.0 / 1300.0, 1e-6);
  EXPECT_NEAR(e.largest, 0.1, 1e-6);
  EXPECT_THROW(errorOf(greys({1.0f}), greys({1.0f}), std::vector<float>{0.0f}), ParameterError);
}

TEST(PictureError, IsOfTheLuminanceOfColours) {
  Image<float> a(1, 1, 3), b(1, 1, 3);
  a.data = {2.0f, 1.0f, 1.0f};
  b.data = {1.0f, 1.0f, 1.0f};
  EXPECT_NEAR(errorOf(a, b).bias, 0.2126, 1e-6);
}

// What is black in the truth counts as a hundredth of its median, or of its mean where most of it is black.
TEST(PictureError, DividesByNoNought) {
  EXPECT_NEAR(errorOf(greys({1.0f, 100.0f, 100.0f}), greys({0.0f, 100.0f, 100.0f})).largest, 1.0, 1e-6);
  EXPECT_NEAR(errorOf(greys({1.0f, 0.0f, 0.0f, 400.0f}), greys({0.0f, 0.0f, 0.0f, 400.0f})).largest, 1.0,
              1e-6);
  EXPECT_THROW(errorOf(greys({1.0f, 1.0f}), greys({0.0f, 0.0f})), ParameterError);
}

TEST(PictureError, MapsHaveTheErrorsWithTheirSigns) {
  const Image<float> map = biasMap(greys({110.0f, 150.0f, 400.0f}), greys({100.0f, 200.0f, 400.0f}));
  EXPECT_NEAR(map.data[0], 0.1f, 1e-6f);
  EXPECT_NEAR(map.data[1], -0.25f, 1e-6f);
  EXPECT_EQ(map.data[2], 0.0f);
}

TEST(PictureError, ColoursSayWhichSide) {
  const Image<float> colours = biasColours(greys({-2.0f, -0.5f, 0.0f, 0.5f, 2.0f}), 0.5);
  const auto at = [&](int i, int c) { return colours.at(i, 0, c); };
  EXPECT_GT(at(1, 2), at(1, 0) + 0.3f);  // dark: blue
  EXPECT_GT(at(3, 0), at(3, 2) + 0.3f);  // bright: red
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(at(0, c), at(1, c));  // no further than the range
    EXPECT_EQ(at(4, c), at(3, c));
    EXPECT_EQ(at(2, c), at(2, 0));  // grey
  }
  // Ever lighter.
  const Image<float> flip = flipColours(greys({0.0f, 0.25f, 0.5f, 0.75f, 1.0f}));
  for (int i = 1; i < 5; ++i)
    EXPECT_GT(
        0.2126f * flip.at(i, 0, 0) + 0.7152f * flip.at(i, 0, 1) + 0.0722f * flip.at(i, 0, 2),
        0.2126f * flip.at(i - 1, 0, 0) + 0.7152f * flip.at(i - 1, 0, 1) + 0.0722f * flip.at(i - 1, 0, 2));
}

}  // namespace
}  // namespace welkin::reference
