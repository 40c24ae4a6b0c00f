// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/tile.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "welkin/core/normal.h"
#include "welkin/core/ordered_key.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/noise/noise.h"

namespace welkin::noise {
namespace {

void normalise(std::vector<float>& v) {
  double sum = 0.0, squares = 0.0;
  for (float x : v) {
    sum += x;
    squares += static_cast<double>(x) * x;
  }
  const double mean = sum / static_cast<double>(v.size());
  const double deviation = std::sqrt(std::max(squares / static_cast<double>(v.size()) - mean * mean, 1e-20));
  for (float& x : v) x = static_cast<float>((x - mean) / deviation);
}

// Indices of v from its least value to its greatest, equal ones in their order: a radix sort of three 11-bit
// digits, which is stable and several times faster than comparing.
std::vector<std::uint32_t> orderOf(const std::vector<float>& v) {
  struct Item {
    std::uint32_t key, index;
  };
  constexpr int kDigitBits = 11, kDigits = 3;
  constexpr std::uint32_t kBuckets = 1u << kDigitBits;
  std::vector<Item> items(v.size()), sorted(v.size());
  for (std::uint32_t i = 0; i < v.size(); ++i) items[i] = {orderedKey(v[i]), i};
  for (int digit = 0; digit < kDigits; ++digit) {
    const int shift = digit * kDigitBits;
    std::vector<std::uint32_t> next(kBuckets + 1);
    for (const Item& item : items) ++next[((item.key >> shift) & (kBuckets - 1)) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const Item& item : items) sorted[next[(item.key >> shift) & (kBuckets - 1)]++] = item;
    std::swap(items, sorted);
  }
  std::vector<std::uint32_t> order(v.size());
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].index;
  return order;
}

// Replaces each value by the normal quantile of its rank.
void makeGaussian(std::vector<float>& v) {
  const std::vector<std::uint32_t> order = orderOf(v);
  const double count = static_cast<double>(v.size());
  parallelFor(v.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t rank = begin; rank < end; ++rank)
      v[order[rank]] = static_cast<float>(normalQuantile((static_cast<double>(rank) + 0.5) / count));
  });
}

// What a sum over the unit tile is for noise.h.
NoiseParams paramsOf(Kind kind, std::uint64_t seed, int dimensions, const Octaves& sum) {
  NoiseParams p;
  p.kind = kind;
  p.dimensions = dimensions;
  p.frequency = glm::dvec3(sum.frequency);
  p.octaves = sum.octaves;
  p.lacunarity = sum.lacunarity;
  p.persistence = sum.persistence;
  p.seed = static_cast<std::int64_t>(seed);
  return p;
}

// out += scale * (the noise's sum, each octave in its deviations about its mean).
void add(const NoiseParams& params, glm::ivec3 size, float scale, std::vector<float>& out) {
  NoiseParams p = params;
  p.normalisation = Normalisation::kUnitVariance;
  double squares = 0.0;
  for (int o = 0; o < p.octaves; ++o) squares += std::pow(p.persistence, 2.0 * o);
  scale *= static_cast<float>(std::sqrt(squares));  // the normalisation has divided by it
  std::vector<float> values(out.size());
  Noise(p).fill(Grid::tile(size), std::span(values));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += scale * values[i];
}

}  // namespace

Volume<float> billowVolume(std::uint64_t seed, int n, const Octaves& sum, float billow) {
  Volume<float> volume(n, n, n, 1);
  const glm::ivec3 size(n);
  if (billow < 1.0f) add(paramsOf(Kind::kPerlin, hashOf(seed, 1), 3, sum), size, 1.0f - billow, volume.data);
  if (billow > 0.0f) add(paramsOf(Kind::kCellular, hashOf(seed, 2), 3, sum), size, -billow, volume.data);
  normalise(volume.data);
  return volume;
}

Image<float> gaussianMap(std::uint64_t seed, int n, const Octaves& sum) {
  Image<float> map(n, n, 1);
  Noise(paramsOf(Kind::kPerlin, seed, 2, sum)).fill(Grid::tile({n, n, 1}), std::span(map.data));
  makeGaussian(map.data);
  return map;
}

Image<float> gaussianCellMap(std::uint64_t seed, int n, const Octaves& sum) {
  Image<float> map(n, n, 1);
  add(paramsOf(Kind::kPerlin, hashOf(seed, 1), 2, sum), {n, n, 1}, 0.35f, map.data);
  add(paramsOf(Kind::kCellular, hashOf(seed, 2), 2, sum), {n, n, 1}, -1.0f, map.data);
  makeGaussian(map.data);
  return map;
}

}  // namespace welkin::noise
