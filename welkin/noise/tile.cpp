// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/tile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/noise/cellular.h"
#include "welkin/noise/perlin.h"

namespace welkin::noise {
namespace {

constexpr float kPerlinDeviation = 0.27f;  // of gradient noise
constexpr float kCellular3Mean = 0.52f,
                kCellular3Deviation = 0.17f;  // of F1 in space (uniform points, one a cell)
constexpr float kCellular2Mean = 0.45f, kCellular2Deviation = 0.20f;  // of F1 in the plane

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

// Quantile function of the normal distribution: Abramowitz & Stegun 1964, 26.2.23, absolute error
// below 4.5e-4.
float normalQuantile(double p) {
  const bool upper = p > 0.5;
  const double t = std::sqrt(-2.0 * std::log(upper ? 1.0 - p : p));
  const double z =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return static_cast<float>(upper ? z : -z);
}

// A key whose order as an integer is that of the float (not a NaN): negative numbers are stored as sign and
// magnitude.
std::uint32_t orderedKey(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 becomes +0, its equal
  return bits >> 31 ? ~bits : bits | 0x80000000u;
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
      v[order[rank]] = normalQuantile((static_cast<double>(rank) + 0.5) / count);
  });
}

// Calls fill(row, y) for each row of an n x n map of zeros.
template <class Fill>
Image<float> fillMap(int n, const Fill& fill) {
  Image<float> image(n, n, 1);
  parallelFor(n, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      fill(std::span<float>(&image.at(0, static_cast<int>(y)), n), static_cast<int>(y));
  });
  return image;
}

int frequencyOf(const Fractal& fractal, int octave) {
  int f = fractal.frequency;
  for (int o = 0; o < octave; ++o) f *= fractal.lacunarity;
  return f;
}

// Cells for each sample of a row of n, in octave `octave`.
float stepOf(const Fractal& fractal, int octave, int n) {
  return static_cast<float>(frequencyOf(fractal, octave)) / static_cast<float>(n);
}

// Adds the fractal sum of gradient noise, in its deviations, along row y of a square map.
void addGradientRow(std::span<float> row, int y, const Perlin& perlin, const Fractal& fractal, float weight) {
  weight /= kPerlinDeviation;
  for (int o = 0; o < fractal.octaves; ++o, weight *= fractal.persistence) {
    const int f = frequencyOf(fractal, o);
    const float step = stepOf(fractal, o, static_cast<int>(row.size()));
    // Each octave in its own plane of the lattice, off the lattice points' zeros.
    perlin.addRow(row, weight, step, (static_cast<float>(y) + 0.5f) * step,
                  static_cast<float>(o) * 7.0f + 0.5f, {f, f, 256});
  }
}

}  // namespace

Volume<float> billowVolume(std::uint64_t seed, int n, const Fractal& fractal, float billow) {
  Volume<float> volume(n, n, n, 1);
  const Perlin perlin(hashOf(seed, 1));
  std::vector<Cellular> cells;
  cells.reserve(static_cast<std::size_t>(fractal.octaves));
  for (int o = 0; o < fractal.octaves; ++o)
    cells.emplace_back(hashOf(seed, 2, o), glm::ivec3(frequencyOf(fractal, o)));
  parallelFor(static_cast<std::size_t>(n) * n, n, [&](std::size_t begin, std::size_t end) {
    std::vector<float> distance(n);
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row % n), z = static_cast<int>(row / n);
      const std::span<float> out(&volume.at(0, y, z), n);
      float weight = 1.0f;
      for (int o = 0; o < fractal.octaves; ++o, weight *= fractal.persistence) {
        const float step = stepOf(fractal, o, n);
        const float py = (static_cast<float>(y) + 0.5f) * step, pz = (static_cast<float>(z) + 0.5f) * step;
        if (billow < 1.0f)
          perlin.addRow(out, weight * (1.0f - billow) / kPerlinDeviation, step, py, pz,
                        glm::ivec3(frequencyOf(fractal, o)));
        if (billow > 0.0f) {
          cells[o].f1Row(distance, step, py, pz);
          const float scale = weight * billow / kCellular3Deviation;
          for (int x = 0; x < n; ++x) out[x] += scale * (kCellular3Mean - distance[x]);
        }
      }
    }
  });
  normalise(volume.data);
  return volume;
}

Image<float> gaussianMap(std::uint64_t seed, int n, const Fractal& fractal) {
  const Perlin perlin(seed);
  Image<float> map =
      fillMap(n, [&](std::span<float> row, int y) { addGradientRow(row, y, perlin, fractal, 1.0f); });
  makeGaussian(map.data);
  return map;
}

Image<float> gaussianCellMap(std::uint64_t seed, int n, const Fractal& fractal) {
  const Perlin perlin(hashOf(seed, 1));
  std::vector<Cellular> cells;
  for (int o = 0; o < fractal.octaves; ++o) {
    const int f = frequencyOf(fractal, o);
    cells.emplace_back(hashOf(seed, 2, o), glm::ivec3(f, f, 1));
  }
  Image<float> map = fillMap(n, [&](std::span<float> row, int y) {
    addGradientRow(row, y, perlin, fractal, 0.35f);
    std::vector<float> distance(row.size());
    float weight = 1.0f / kCellular2Deviation;
    for (int o = 0; o < fractal.octaves; ++o, weight *= fractal.persistence) {
      const float step = stepOf(fractal, o, n);
      cells[o].f1Row(distance, step, (static_cast<float>(y) + 0.5f) * step);
      for (std::size_t x = 0; x < row.size(); ++x) row[x] += weight * (kCellular2Mean - distance[x]);
    }
  });
  makeGaussian(map.data);
  return map;
}

}  // namespace welkin::noise
