// SPDX-License-Identifier: Apache-2.0
// The mathematics of mipmaps: means, constants, edges, frequencies, streams and threads.
#include "welkin/io/mipmaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "some_texels.h"
#include "welkin/core/parallel.h"

namespace welkin::io {
namespace {

std::vector<Texels> mipmapsOf(const Texels& top, MipFilter filter, MipEdges edges) {
  std::vector<Texels> levels;
  for (const TexelShape& shape : mipShapes(top.shape)) levels.emplace_back(shape);
  levels[0].bytes = top.bytes;
  MipChain chain(top.shape, filter, edges, [&](int level, int run, std::span<const std::byte> texels) {
    Texels& to = levels[static_cast<std::size_t>(level)];
    std::copy(
        texels.begin(), texels.end(),
        to.bytes.begin() + static_cast<std::ptrdiff_t>(texels.size()) * static_cast<std::ptrdiff_t>(run));
  });
  const std::size_t run = top.shape.volume ? top.shape.sliceBytes() : top.shape.rowBytes();
  for (std::size_t at = 0; at < top.bytes.size(); at += run) chain.add(std::span(top.bytes).subspan(at, run));
  return levels;
}

double meanOf(const Texels& texels, int channel) {
  const TexelShape& s = texels.shape;
  double sum = 0.0;
  for (int z = 0; z < s.nz; ++z)
    for (int y = 0; y < s.ny; ++y)
      for (int x = 0; x < s.nx; ++x) sum += static_cast<double>(texels.value(x, y, z, channel));
  return sum / s.nx / s.ny / s.nz;
}

TEST(Mipmaps, SizesGoDownToOne) {
  const auto shapes = mipShapes(volumeOf("l8", 13, 4, 1));
  ASSERT_EQ(shapes.size(), 4u);
  EXPECT_EQ(shapes[1], volumeOf("l8", 6, 2, 1));
  EXPECT_EQ(shapes[2], volumeOf("l8", 3, 1, 1));
  EXPECT_EQ(shapes[3], volumeOf("l8", 1, 1, 1));
  EXPECT_EQ(mipShapes(pictureOf("l8", 1, 1)).size(), 1u);
}

TEST(Mipmaps, WeightsOfATexelSumToOneAndOfTheBoxOfEachSourceAreEqual) {
  for (int size = 1; size <= 67; ++size)
    for (const MipFilter filter : {MipFilter::kBox, MipFilter::kKaiser}) {
      const auto taps = mipTaps(size, filter);
      EXPECT_EQ(taps.size(), static_cast<std::size_t>(std::max(size / 2, 1)));
      std::map<int, double> given;
      for (const MipTap& tap : taps) {
        double sum = 0.0;
        for (std::size_t j = 0; j < tap.weights.size(); ++j) {
          sum += static_cast<double>(tap.weights[j]);
          given[tap.first + static_cast<int>(j)] += static_cast<double>(tap.weights[j]);
        }
        EXPECT_NEAR(sum, 1.0, 1e-6);
      }
      if (filter == MipFilter::kKaiser) continue;
      ASSERT_EQ(given.size(), static_cast<std::size_t>(size));
      for (const auto& [source, sum] : given)
        EXPECT_NEAR(sum, static_cast<double>(taps.size()) / size, 1e-6) << source << " of " << size;
    }
}

TEST(Mipmaps, TheBoxKeepsTheMeanForOddSizesToo) {
  for (const TexelShape& shape :
       {volumeOf("rgba32f", 13, 7, 9), pictureOf("r32f", 31, 17), volumeOf("r32f", 5, 1, 3),
        pictureOf("rgb32f", 1, 23), volumeOf("r32f", 16, 16, 16)}) {
    const Texels top = randomTexels(shape);
    for (const Texels& level : mipmapsOf(top, MipFilter::kBox, MipEdges::kClamp))
      for (int c = 0; c < countOf(shape.format.channels); ++c)
        EXPECT_NEAR(meanOf(level, c), meanOf(top, c), 2e-6);
  }
}

TEST(Mipmaps, TheKaiserKeepsTheMeanOfTiles) {
  const Texels top = randomTexels(volumeOf("r32f", 32, 16, 16));
  for (const Texels& level : mipmapsOf(top, MipFilter::kKaiser, MipEdges::kRepeat))
    EXPECT_NEAR(meanOf(level, 0), meanOf(top, 0), 2e-6);
}

TEST(Mipmaps, ConstantsStay) {
  for (const MipFilter filter : {MipFilter::kBox, MipFilter::kKaiser})
    for (const MipEdges edges : {MipEdges::kClamp, MipEdges::kRepeat}) {
      Texels top(volumeOf("la8", 21, 10, 5));
      for (std::size_t i = 0; i < top.bytes.size(); ++i)
        top.bytes[i] = i % 2 == 0 ? std::byte{77} : std::byte{255};
      for (const Texels& level : mipmapsOf(top, filter, edges))
        for (std::size_t i = 0; i < level.bytes.size(); ++i)
          EXPECT_EQ(level.bytes[i], i % 2 == 0 ? std::byte{77} : std::byte{255});
    }
}

TEST(Mipmaps, TheBoxOfEvenSizesIsTheMeanOfEight) {
  const Texels top = randomTexels(volumeOf("r8", 6, 4, 2));
  const Texels half = mipmapsOf(top, MipFilter::kBox, MipEdges::kClamp)[1];
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      double sum = 0.0;
      for (int i = 0; i < 8; ++i)
        sum += static_cast<double>(top.value(2 * x + (i & 1), 2 * y + (i >> 1 & 1), i >> 2));
      EXPECT_NEAR(half.value(x, y, 0), sum / 8, 0.501 / 255);
    }
}

// How much of a wave of `cycles` over 64 texels is left in the next level, in amplitude.
double response(MipFilter filter, int cycles) {
  Texels top(pictureOf("r32f", 64, 2));
  for (int i = 0; i < 128; ++i)
    top.as<float>()[static_cast<std::size_t>(i)] =
        static_cast<float>(std::cos(2.0 * std::numbers::pi * cycles * (i % 64 + 0.5) / 64));
  const Texels half = mipmapsOf(top, filter, MipEdges::kRepeat)[1];
  double power = 0.0;
  for (const float x : half.as<float>()) power += 2.0 * static_cast<double>(x) * static_cast<double>(x) / 32;
  return std::sqrt(power);
}

// What the smaller level can hold stays, what it cannot hold (16 cycles and more) goes: the Kaiser window
// does both better than the box.
TEST(Mipmaps, TheKaiserIsSharperAndAliasesLess) {
  EXPECT_NEAR(response(MipFilter::kKaiser, 2), 1.0, 0.01);
  EXPECT_NEAR(response(MipFilter::kBox, 8), std::cos(std::numbers::pi / 8), 1e-3);
  EXPECT_GT(response(MipFilter::kKaiser, 8), 0.99);
  EXPECT_NEAR(response(MipFilter::kBox, 24), std::cos(3 * std::numbers::pi / 8), 1e-3);
  EXPECT_LT(response(MipFilter::kKaiser, 24), 0.02);
}

// A tile that is shifted by two texels gives a level that is shifted by one.
TEST(Mipmaps, RepeatedEdgesAreSeamless) {
  const Texels top = randomTexels(volumeOf("r32f", 16, 8, 12));
  Texels shifted(top.shape);
  for (int z = 0; z < 12; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x)
        shifted.as<float>()[static_cast<std::size_t>((z * 8 + y) * 16 + x)] =
            top.value((x + 2) % 16, (y + 4) % 8, (z + 6) % 12);
  const Texels a = mipmapsOf(top, MipFilter::kKaiser, MipEdges::kRepeat)[1];
  const Texels b = mipmapsOf(shifted, MipFilter::kKaiser, MipEdges::kRepeat)[1];
  for (int z = 0; z < 6; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x)
        EXPECT_NEAR(b.value(x, y, z), a.value((x + 1) % 8, (y + 2) % 4, (z + 3) % 6), 2e-6);
}

TEST(Mipmaps, ThreadsChangeNothing) {
  const Texels top = randomTexels(volumeOf("rgba8", 130, 70, 9));
  setThreadCount(1);
  const auto one = mipmapsOf(top, MipFilter::kKaiser, MipEdges::kClamp);
  setThreadCount(5);
  const auto five = mipmapsOf(top, MipFilter::kKaiser, MipEdges::kClamp);
  setThreadCount(0);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].bytes, five[i].bytes);
}

}  // namespace
}  // namespace welkin::io
