// SPDX-License-Identifier: Apache-2.0
// FLIP against what the program of its authors (flip-evaluator 1.7) says of pictures made by formula.
#include "welkin/reference/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace welkin::reference {
namespace {

using Colour = std::function<double(int x, int y, int c)>;

Image<float> pictureOf(const Colour& colour) {
  Image<float> p(64, 48, 3);
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      for (int c = 0; c < 3; ++c) p.at(x, y, c) = static_cast<float>(std::clamp(colour(x, y, c), 0.0, 1.0));
  return p;
}

double grey(int, int, int) {
  return 0.5;
}
double waves(int x, int y, int c) {
  if (c == 0) return 0.5 + 0.4 * std::sin(0.31 * x + 0.05 * y);
  if (c == 1) return 0.5 + 0.4 * std::sin(0.17 * x - 0.23 * y);
  return 0.5 + 0.3 * std::cos(0.11 * y * x / 20.0);
}

double meanOf(const Image<float>& map) {
  double sum = 0.0;
  for (const float v : map.data) sum += static_cast<double>(v);
  return sum / static_cast<double>(map.data.size());
}
float mostOf(const Image<float>& map) {
  return *std::max_element(map.data.begin(), map.data.end());
}

TEST(Flip, IsThatOfItsAuthorsProgramForWaves) {
  const Image<float> flip = flipOf(pictureOf(waves), pictureOf([](int x, int y, int c) {
                                     const double gain[] = {1.1, 0.95, 1.0};
                                     return waves(x, y, c) * gain[c] + 0.05 * std::sin(0.9 * x);
                                   }));
  EXPECT_NEAR(meanOf(flip), 0.292054, 2e-4);
  EXPECT_NEAR(mostOf(flip), 0.492711f, 1e-3f);
  EXPECT_NEAR(flip.at(32, 24), 0.296758f, 1e-3f);
  EXPECT_NEAR(flip.at(0, 0), 0.259870f, 1e-3f);
  EXPECT_NEAR(flip.at(50, 10), 0.263462f, 1e-3f);
}

TEST(Flip, IsThatOfItsAuthorsProgramForADot) {
  const Image<float> flip = flipOf(pictureOf(grey), pictureOf([](int x, int y, int c) {
                                     const double dot[] = {0.9, 0.8, 0.7};
                                     return x >= 30 && x < 33 && y >= 20 && y < 23 ? dot[c] : 0.5;
                                   }));
  EXPECT_NEAR(meanOf(flip), 0.008554, 1e-5);
  EXPECT_NEAR(mostOf(flip), 0.721863f, 1e-3f);
  EXPECT_NEAR(flip.at(32, 24), 0.236467f, 1e-3f);
  EXPECT_NEAR(flip.at(50, 10), 0.0f, 1e-6f);
}

TEST(Flip, IsThatOfItsAuthorsProgramForEvenPictures) {
  const Image<float> lighter = flipOf(pictureOf(grey), pictureOf([](int, int, int) { return 0.6; }));
  EXPECT_NEAR(meanOf(lighter), 0.285063, 1e-4);
  const Image<float> most = flipOf(pictureOf([](int, int, int c) { return c == 1 ? 1.0 : 0.0; }),
                                   pictureOf([](int, int, int c) { return c == 2 ? 1.0 : 0.0; }));
  EXPECT_NEAR(meanOf(most), 1.0, 1e-5);
}

TEST(Flip, IsNoughtForTheSameAndTheSameBothWays) {
  const Image<float> a = pictureOf(waves), b = pictureOf(grey);
  EXPECT_EQ(mostOf(flipOf(a, a)), 0.0f);
  EXPECT_EQ(flipOf(a, b).data, flipOf(b, a).data);
}

}  // namespace
}  // namespace welkin::reference
