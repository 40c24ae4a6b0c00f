// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/quantise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scratch.h"
#include "welkin/core/parallel.h"

namespace welkin::io {
namespace {

Image<float> flat(int size, float value, int channels = 1) {
  Image<float> image(size, size, channels);
  for (float& x : image.data) x = value;
  return image;
}

TEST(Quantise, MultiplesAreExactEverywhere) {
  for (int n = 0; n <= 255; ++n) {
    const Image<std::uint8_t> q = quantise8(flat(64, static_cast<float>(n) / 255.0f));
    for (const std::uint8_t x : q.data) ASSERT_EQ(x, n);
  }
}

TEST(Quantise, DitheringKeepsTheMean) {
  for (const float value : {0.1f, 0.3337f, 0.5f, 0.90211f}) {
    const Image<std::uint8_t> q = quantise8(flat(128, value));
    double sum = 0;
    for (const std::uint8_t x : q.data) {
      EXPECT_LT(std::abs(x - value * 255.0f), 1.0f);
      sum += x;
    }
    EXPECT_NEAR(sum / static_cast<double>(q.data.size()), value * 255.0, 0.01);
  }
}

// A band is a run of equal values where the gradient still rises. Dithered, no 16 x 16 block strays from the
// truth by as much as the half level that rounding would cost.
TEST(Quantise, GradientsHaveNoBands) {
  Image<float> ramp(1024, 16, 1);
  for (int y = 0; y < ramp.height; ++y)
    for (int x = 0; x < ramp.width; ++x)
      ramp.at(x, y) = 0.5f + 4.0f / 255.0f * static_cast<float>(x) / 1024.0f;
  const Image<std::uint8_t> q = quantise8(ramp);
  for (int block = 0; block < 64; ++block) {
    double error = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = block * 16; x < block * 16 + 16; ++x) error += q.at(x, y) - ramp.at(x, y) * 255.0;
    EXPECT_LT(std::abs(error / 256), 0.06) << block;
  }
}

// The error is of high spatial frequency: means of 4 x 4 pixels scatter less than those of white noise, 0.5 /
// 4 at half a level.
TEST(Quantise, ErrorIsMostlyHighFrequency) {
  const Image<std::uint8_t> q = quantise8(flat(256, 100.5f / 255.0f));
  double variance = 0;
  for (int by = 0; by < 64; ++by)
    for (int bx = 0; bx < 64; ++bx) {
      double mean = 0;
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) mean += q.at(bx * 4 + x, by * 4 + y) / 16.0;
      variance += (mean - 100.5) * (mean - 100.5) / 4096;
    }
  EXPECT_LT(std::sqrt(variance), 0.5 * 0.125);
}

TEST(Quantise, AllChannelsShareTheThreshold) {
  const Image<std::uint8_t> q = quantise8(flat(32, 0.4321f, 3));
  for (std::size_t i = 0; i < q.data.size(); i += 3) {
    EXPECT_EQ(q.data[i], q.data[i + 1]);
    EXPECT_EQ(q.data[i], q.data[i + 2]);
  }
}

TEST(Quantise, SixteenBitsRoundAndClamp) {
  Image<float> image(4, 1, 1);
  image.data = {-3.0f, 0.5f, 1.0f, 1e30f};
  EXPECT_EQ(quantise16(image).data, (std::vector<std::uint16_t>{0, 32768, 65535, 65535}));
  EXPECT_EQ(quantise8(image).at(0, 0), 0);
  EXPECT_EQ(quantise8(image).at(3, 0), 255);
}

TEST(Quantise, SameForAnyNumberOfThreads) {
  Image<float> image(97, 65, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i % 1013) / 1013.0f;
  setThreadCount(1);
  const auto one = quantise8(image).data;
  setThreadCount(3);
  EXPECT_EQ(quantise8(image).data, one);
  setThreadCount(0);
}

TEST(Quantise, NumbersThatAreNoneAreNamed) {
  Image<float> image = flat(8, 0.5f, 3);
  image.at(5, 3, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(messageOf<ParameterError>([&] { quantise8(image); }),
            "the picture has no number at pixel (5, 3), channel 1");
  image.at(5, 3, 1) = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(messageOf<ParameterError>([&] { quantise16(image); }),
            "the picture has an infinite value at pixel (5, 3), channel 1");
}

}  // namespace
}  // namespace welkin::io
