// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/accumulation.h"

#include <gtest/gtest.h>

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

TEST(RoughTiles, FlatAreasAndGradientsAreSettled) {
  EXPECT_TRUE(roughTiles(grey(100, 70, [](int, int) { return 3.0f; }), 0.01f).empty());
  EXPECT_TRUE(
      roughTiles(grey(100, 70, [](int x, int y) { return 10.0f + 0.5f * x + 0.25f * y; }), 0.01f).empty());
  EXPECT_TRUE(roughTiles(grey(1, 1, [](int, int) { return 1.0f; }), 0.01f).empty());
}

// Tiles are 16 pixels; they count from the bottom, and neighbours in a row are one.
TEST(RoughTiles, AnEdgeMarksItsTilesAlone) {
  const auto tiles = roughTiles(
      grey(128, 96, [](int x, int y) { return x >= 40 && x < 80 && y < 10 ? 2.0f : 1.0f; }), 0.01f);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].x, 32);
  EXPECT_EQ(tiles[0].width, 64);
  EXPECT_EQ(tiles[0].y, 80);
  EXPECT_EQ(tiles[0].height, 16);
}

TEST(RoughTiles, GrainIsRough) {
  const auto tiles =
      roughTiles(grey(64, 64, [](int x, int y) { return (x * 7 + y * 3) % 5 ? 1.0f : 1.1f; }), 0.01f);
  ASSERT_EQ(tiles.size(), 4u);
  EXPECT_EQ(tiles[0].width, 64);
}

// Later sub-frames go on where the halves disagree alone, and not where there have been none.
TEST(UnsettledTiles, AreThoseWhoseHalvesDisagree) {
  const Image<float> before = grey(64, 16, [](int x, int) { return x % 2 ? 1.0f : 3.0f; });
  Image<float> sums = before;
  for (int y = 0; y < 16; ++y)
    for (int x = 16; x < 64; ++x) {
      const float times = x < 32 ? 1.0f : x < 48 ? 1.05f : 1.015f;
      for (int c = 0; c < 3; ++c) sums.at(x, y, c) += times * before.at(x, y, c);
      sums.at(x, y, 3) += 1.0f;
    }
  // Five percent between two are two and a half of their mean.
  const auto tiles = unsettledTiles(before, sums, 0.012f);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].x, 32);
  EXPECT_EQ(tiles[0].width, 16);
  EXPECT_EQ(unsettledTiles(before, sums, 0.005f).front().width, 32);
  // A single pixel is enough.
  sums.at(20, 5, 1) *= 1.2f;
  EXPECT_EQ(unsettledTiles(before, sums, 0.012f).front().x, 16);
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
