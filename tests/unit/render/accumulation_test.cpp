// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/accumulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// Something to judge everywhere: a wave, and grain.
Image<float> wave(int width, int height, float phase) {
  return grey(width, height, [&](int x, int y) {
    const float grain = 0.03f * static_cast<float>((x * 7 + y * 3) % 5) * (x % 17 < 9 ? 1.0f : 0.0f);
    return 1.0f + 0.3f * std::sin(0.12f * static_cast<float>(x) + 0.05f * static_cast<float>(y) + phase) +
           grain;
  });
}

Image<float> columns(const Image<float>& picture, int from, int count) {
  Image<float> piece(count, picture.height, picture.channels);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < count; ++x)
      for (int c = 0; c < picture.channels; ++c)
        piece.at(x, y, c) = picture.at((from + x) % picture.width, y, c);
  return piece;
}

// No face of a cube knows of those beside it in the picture, whatever its size in blocks.
TEST(Forms, FacesAreApart) {
  for (const int side : {3, 30, 32}) {
    const Image<float> strip = wave(6 * side, side, 0.0f), later = wave(6 * side, side, 0.1f);
    Image<float> sums = strip;
    for (std::size_t i = 0; i < sums.data.size(); ++i) sums.data[i] += later.data[i];
    const auto half = firstHalf(6 * side, side, Form::kSixFaces);
    Image<float> first = strip;
    for (std::size_t i = 0; i < first.data.size(); ++i)
      if (half.data[i / 4] == 0) first.data[i] = 0.0f;
    const Image<float> cover = hidden(6 * side, side, 1.0f), coverOfFace = hidden(side, side, 1.0f);
    const auto second = secondHalf(first, cover, 0.05f, Form::kSixFaces);
    Image<float> whole = strip;
    for (std::size_t i = 0; i < whole.data.size(); ++i)
      if (half.data[i / 4] + second.data[i / 4] == 0) whole.data[i] = 0.0f;
    const Image<float> before = whole;
    const auto filled = fillBlocks(whole, Form::kSixFaces);
    const auto rough = roughBlocks(strip, 0.01f, Form::kSixFaces),
               unsettled = unsettledBlocks(strip, sums, 0.005f, Form::kSixFaces);
    const Image<float> picture = resolve(sums, 0.04f, Form::kSixFaces);
    const auto faceOf = [&](const auto& all, int f) {
      auto face = all;
      face = {side, side, all.channels};
      for (int y = 0; y < side; ++y)
        std::copy_n(&all.data[all.index(f * side, y)], side * all.channels, &face.data[face.index(0, y)]);
      return face.data;
    };
    for (int f = 0; f < 6; ++f) {
      const auto of = [&](const Image<float>& all) { return columns(all, f * side, side); };
      EXPECT_EQ(faceOf(half, f), firstHalf(side, side).data);
      EXPECT_EQ(faceOf(second, f), secondHalf(of(first), coverOfFace, 0.05f).data);
      Image<float> face = of(before);
      EXPECT_EQ(faceOf(filled, f), fillBlocks(face).data);
      EXPECT_EQ(faceOf(whole, f), face.data);
      EXPECT_EQ(faceOf(rough, f), roughBlocks(of(strip), 0.01f).data);
      EXPECT_EQ(faceOf(unsettled, f), unsettledBlocks(of(strip), of(sums), 0.005f).data);
      EXPECT_EQ(faceOf(picture, f), resolve(of(sums), 0.04f).data);
    }
  }
}

// A picture that goes around is the same wherever it is cut open.
TEST(Forms, AroundThereIsNoSeam) {
  constexpr int kWide = 64, kTurn = 24;
  const Image<float> strip = wave(kWide, 16, 0.0f), later = wave(kWide, 16, 0.1f);
  Image<float> sums = strip;
  for (std::size_t i = 0; i < sums.data.size(); ++i) sums.data[i] += later.data[i];
  const auto turned = [&](const Image<float>& picture) { return columns(picture, kTurn, kWide); };
  EXPECT_EQ(turned(resolve(sums, 0.04f, Form::kAround)).data,
            resolve(turned(sums), 0.04f, Form::kAround).data);
  const auto same = [&](const Image<std::uint8_t>& blocks, const Image<std::uint8_t>& ofTurned) {
    for (int y = 0; y < blocks.height; ++y)
      for (int x = 0; x < kWide; ++x)
        if (blocks.at((x + kTurn) % kWide, y) != ofTurned.at(x, y)) return false;
    return true;
  };
  EXPECT_TRUE(
      same(roughBlocks(strip, 0.01f, Form::kAround), roughBlocks(turned(strip), 0.01f, Form::kAround)));
  EXPECT_TRUE(same(unsettledBlocks(strip, sums, 0.005f, Form::kAround),
                   unsettledBlocks(turned(strip), turned(sums), 0.005f, Form::kAround)));
  // An edge that lies in the seam is one.
  const auto step = [](int x, int) { return x < 32 ? 1.0f : 2.0f; };
  EXPECT_EQ(roughBlocks(grey(kWide, 8, step), 0.01f, Form::kAround).at(0, 0), 1);
  EXPECT_EQ(roughBlocks(grey(kWide, 8, step), 0.01f).at(0, 0), 0);
}

}  // namespace
}  // namespace welkin::render
