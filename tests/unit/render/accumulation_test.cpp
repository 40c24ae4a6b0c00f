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

// What the first half has of a picture.
Image<float> halfOf(Image<float> picture) {
  const auto drawn = firstHalf(picture.width, picture.height);
  for (std::size_t i = 0; i < picture.data.size(); ++i)
    if (drawn.data[i / 4] == 0) picture.data[i] = 0.0f;
  return picture;
}
// The share of what is behind that clouds hide, everywhere but in one block.
Image<float> hidden(int width, int height, float share, int blockX = -1, int blockY = -1) {
  Image<float> image(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = x / 4 == blockX && y / 4 == blockY ? 0.9f : share;
  return image;
}

TEST(FirstHalf, IsAChessboardOfBlocks) {
  const auto half = firstHalf(30, 21);
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 30; ++x) EXPECT_EQ(half.at(x, y), (x / 4 + y / 4) % 2 == 0 ? 1 : 0);
}

// All but the second half of the inner 9 x 9 of 15 x 15 blocks, whose neighbours' neighbours are in the
// picture.
TEST(SecondHalf, LeavesOutWhatIsTold) {
  constexpr int kTold = 40 * 16, kSecond = 112 * 16;
  const auto half = halfOf(grey(60, 60, [](int x, int y) { return 30.0f + 0.2f * x - 0.1f * y; }));
  EXPECT_EQ(count(secondHalf(half, hidden(60, 60, 1.0f), 0.01f)), kSecond - kTold);
  // Stars might be seen there, or an edge.
  EXPECT_EQ(count(secondHalf(half, hidden(60, 60, 0.9f), 0.01f)), kSecond);
  EXPECT_EQ(count(secondHalf(half, hidden(60, 60, 1.0f, 7, 7), 0.01f)), kSecond - kTold + 4 * 16);
}

TEST(SecondHalf, DrawsWhereGuessesDiffer) {
  const auto wanted = [](const std::function<float(int, int)>& luminance) {
    return secondHalf(halfOf(grey(60, 60, luminance)), hidden(60, 60, 1.0f), 0.01f);
  };
  const auto ridge = wanted([](int x, int) { return 1.0f - 0.002f * (x - 30) * (x - 30); });
  EXPECT_EQ(ridge.at(4 * 7, 4 * 6), 1);
  const auto edge = wanted([](int x, int) { return x < 28 ? 1.0f : 1.1f; });
  EXPECT_EQ(edge.at(4 * 6, 4 * 7), 1);   // at its foot
  EXPECT_EQ(edge.at(4 * 10, 4 * 7), 0);  // away from it
  // One that goes straight through a block, which all guesses call a slope, is seen above and below it.
  EXPECT_EQ(wanted([](int x, int) { return x < 30 ? 1.0f : 1.1f; }).at(4 * 7, 4 * 6), 1);
}

TEST(FillBlocks, GivesWhatThoseAroundTell) {
  const auto plane = [](int x, int y) { return 30.0f + 0.2f * x - 0.1f * y; };
  Image<float> first = halfOf(grey(60, 60, plane));
  const auto needed = secondHalf(first, hidden(60, 60, 1.0f), 0.01f);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x)
      if (needed.at(x, y) == 1)
        std::ranges::fill_n(&first.data[first.index(x, y)], 3, plane(x, y)), first.at(x, y, 3) = 1.0f;
  const auto filled = fillBlocks(first);
  EXPECT_EQ(count(filled), 40 * 16);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(first.at(x, y, c), plane(x, y), 1e-4f) << x << ", " << y;
      EXPECT_EQ(first.at(x, y, 3), 1.0f);
      EXPECT_FALSE(needed.at(x, y) == 1 && filled.at(x, y) == 1);
    }
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
