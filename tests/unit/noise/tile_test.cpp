// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "welkin/core/parallel.h"
#include "welkin/noise/noise.h"

namespace welkin::noise {
namespace {

double meanOf(const std::vector<float>& v) {
  double s = 0;
  for (float x : v) s += x;
  return s / static_cast<double>(v.size());
}

double deviationOf(const std::vector<float>& v) {
  const double m = meanOf(v);
  double s = 0;
  for (float x : v) s += (x - m) * (x - m);
  return std::sqrt(s / static_cast<double>(v.size()));
}

TEST(Tile, VolumesAreNormalised) {
  const Volume<float> v = billowVolume(1, 32, {.octaves = 3, .frequency = 4}, 0.7f);
  EXPECT_NEAR(meanOf(v.data), 0.0, 1e-4);
  EXPECT_NEAR(deviationOf(v.data), 1.0, 1e-4);
}

// A threshold on a Gaussian map is a cover: the shares above 0, 1 and 2 deviations are those of the normal
// distribution.
TEST(Tile, MapsAreGaussian) {
  for (const Image<float>& map : {gaussianMap(3, 128, {.octaves = 5, .frequency = 4}),
                                  gaussianCellMap(4, 128, {.octaves = 3, .frequency = 8})}) {
    const double n = static_cast<double>(map.data.size());
    auto shareAbove = [&](float t) {
      return static_cast<double>(
                 std::count_if(map.data.begin(), map.data.end(), [&](float x) { return x > t; })) /
             n;
    };
    EXPECT_NEAR(shareAbove(0.0f), 0.5, 0.001);
    EXPECT_NEAR(shareAbove(1.0f), 0.1587, 0.001);
    EXPECT_NEAR(shareAbove(2.0f), 0.0228, 0.001);
  }
}

// Ranks make the values, so each quantile of the normal distribution is taken exactly once.
TEST(Tile, MapsTakeEachQuantileOnce) {
  const Image<float> map = gaussianMap(9, 64, {.octaves = 3, .frequency = 4});
  std::vector<float> v = map.data;
  std::sort(v.begin(), v.end());
  EXPECT_EQ(std::adjacent_find(v.begin(), v.end()), v.end());
  const std::size_t n = v.size();
  for (std::size_t i = 0; i < n; ++i) {
    // The distribution function undoes the quantile; the approximation of the latter is good to 4.5e-4.
    const double share = 0.5 * std::erfc(-v[i] / std::sqrt(2.0));
    EXPECT_NEAR(share, (static_cast<double>(i) + 0.5) / static_cast<double>(n), 3e-4);
  }
}

// Ranks keep the order of what was ranked: the unranked sum is larger wherever the map is.
TEST(Tile, RankingKeepsTheOrder) {
  const int n = 64;
  const Octaves one{.octaves = 1, .frequency = 5};
  const Image<float> map = gaussianMap(11, n, one);
  const Noise perlin({.dimensions = 2, .frequency = {5, 5, 5}, .octaves = 1, .seed = 11});
  std::vector<std::pair<float, float>> pairs;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      pairs.emplace_back(map.at(x, y),
                         static_cast<float>(perlin.sample({(x + 0.5) / n, (y + 0.5) / n, 0.0})));
  std::sort(pairs.begin(), pairs.end());
  for (std::size_t i = 1; i < pairs.size(); ++i) EXPECT_GE(pairs[i].second, pairs[i - 1].second - 1e-5f);
}

TEST(Tile, MapsAreSeamless) {
  const int n = 128;
  for (const Image<float>& map : {gaussianMap(5, n, {.octaves = 4, .frequency = 4}),
                                  gaussianCellMap(6, n, {.octaves = 2, .frequency = 6})}) {
    double inside = 0, across = 0;
    for (int y = 0; y < n; ++y) {
      inside += std::abs(map.at(n / 2, y) - map.at(n / 2 - 1, y));
      across += std::abs(map.at(0, y) - map.at(n - 1, y));
    }
    EXPECT_LT(across, 2.0 * inside);
    EXPECT_GT(across, 0.0);
  }
}

TEST(Tile, IsTheSameForAnyThreadCount) {
  const int before = threadCount();
  setThreadCount(1);
  const Volume<float> one = billowVolume(8, 32, {.octaves = 3, .frequency = 4}, 0.5f);
  setThreadCount(5);
  const Volume<float> five = billowVolume(8, 32, {.octaves = 3, .frequency = 4}, 0.5f);
  setThreadCount(before);
  EXPECT_EQ(one.data, five.data);
}

}  // namespace
}  // namespace welkin::noise
