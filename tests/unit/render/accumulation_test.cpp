// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/accumulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace welkin::render {
namespace {

Image<float> grey(int width, int height, const std::function<float(int x, int y)>& luminance) {
  Image<float> image(width, height, 4);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = luminance(x, y);
      image.at(x, y, 3) = 1.0f;
    }
  return image;
}

int count(const Image<std::uint8_t>& blocks) {
  return static_cast<int>(std::ranges::count(blocks.data, 1));
}

TEST(RoughBlocks, FlatAreasAndGradientsAreSettled) {
  EXPECT_EQ(count(roughBlocks(grey(100, 70, [](int, int) { return 3.0f; }), 0.01f)), 0);
  EXPECT_EQ(
      count(roughBlocks(grey(100, 70, [](int x, int y) { return 10.0f + 0.5f * x + 0.25f * y; }), 0.01f)), 0);
  EXPECT_EQ(count(roughBlocks(grey(1, 1, [](int, int) { return 1.0f; }), 0.01f)), 0);
}

// Blocks are four pixels; those at the border may be cut.
TEST(RoughBlocks, AnEdgeMarksItsBlocksAlone) {
  const auto rough =
      roughBlocks(grey(90, 30, [](int x, int y) { return x >= 41 && y < 10 ? 2.0f : 1.0f; }), 0.01f);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 90; ++x) {
      const bool side = x >= 40 && x < 44 && y < 12, bottom = x >= 40 && y >= 8 && y < 12;
      EXPECT_EQ(rough.at(x, y), side || bottom ? 1 : 0) << x << ", " << y;
    }
}

TEST(RoughBlocks, GrainIsRough) {
  EXPECT_EQ(
      count(roughBlocks(grey(64, 64, [](int x, int y) { return (x * 7 + y * 3) % 5 ? 1.0f : 1.1f; }), 0.01f)),
      64 * 64);
}

// Later sub-frames go on where the halves disagree alone, and not where there have been none.
TEST(UnsettledBlocks, AreThoseWhoseHalvesDisagree) {
  const Image<float> before = grey(64, 16, [](int x, int) { return x % 2 ? 1.0f : 3.0f; });
  Image<float> sums = before;
  for (int y = 0; y < 16; ++y)
    for (int x = 16; x < 64; ++x) {
      const float times = x < 32 ? 1.0f : x < 48 ? 1.05f : 1.015f;
      for (int c = 0; c < 3; ++c) sums.at(x, y, c) += times * before.at(x, y, c);
      sums.at(x, y, 3) += 1.0f;
    }
  // Five percent between two are two and a half of their mean.
  const auto blocks = unsettledBlocks(before, sums, 0.012f);
  EXPECT_EQ(count(blocks), 16 * 16);
  EXPECT_EQ(blocks.at(32, 0), 1);
  EXPECT_EQ(blocks.at(47, 15), 1);
  EXPECT_EQ(count(unsettledBlocks(before, sums, 0.005f)), 36 * 16);  // and the blocks beside five percent
  // A single pixel is enough.
  sums.at(20, 5, 1) *= 1.2f;
  const auto more = unsettledBlocks(before, sums, 0.012f);
  EXPECT_EQ(count(more), 16 * 16 + 4 * 4);
  EXPECT_EQ(more.at(20, 5), 1);
}

// Means by the counts in alpha; the dither within a surface goes, an edge stays.
TEST(Resolve, TakesDitherOutAndKeepsEdges) {
  Image<float> sums = grey(32, 8, [](int x, int y) {
    const float dither = 0.01f * static_cast<float>((x + 3 * y) % 5 - 2);
    return x < 16 ? 1.0f + dither : 4.0f * (1.0f + dither);
  });
  for (float& v : sums.data) v *= 3.0f;
  const Image<float> picture = resolve(sums, 0.04f);
  for (int y = 2; y < 6; ++y)
    for (int x = 2; x < 30; ++x) EXPECT_NEAR(picture.at(x, y, 1) / (x < 16 ? 1.0f : 4.0f), 1.0f, 0.004f) << x;
}

}  // namespace
}  // namespace welkin::render
