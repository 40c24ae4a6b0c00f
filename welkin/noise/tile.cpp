// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/tile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/noise/cellular.h"
#include "welkin/noise/perlin.h"

namespace welkin::noise {
namespace {

constexpr float kPerlinDeviation = 0.27f;    // of gradient noise
constexpr float kCellular3Mean = 0.52f, kCellular3Deviation = 0.17f;  // of F1 in space (uniform points, one a cell)
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

// Quantile function of the normal distribution: Abramowitz & Stegun 1964, 26.2.23, absolute error below 4.5e-4.
float normalQuantile(double p) {
  const bool upper = p > 0.5;
  const double t = std::sqrt(-2.0 * std::log(upper ? 1.0 - p : p));
  const double z = t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                           (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return static_cast<float>(upper ? z : -z);
}

// Replaces each value by the normal quantile of its rank.
void makeGaussian(std::vector<float>& v) {
  std::vector<std::uint32_t> order(v.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return v[a] != v[b] ? v[a] < v[b] : a < b; });
  for (std::size_t rank = 0; rank < order.size(); ++rank)
    v[order[rank]] = normalQuantile((static_cast<double>(rank) + 0.5) / static_cast<double>(v.size()));
}

Image<float> fillMap(int n, const std::function<float(float u, float v)>& f) {
  Image<float> image(n, n, 1);
  parallelFor(n, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < n; ++x)
        image.at(x, static_cast<int>(y)) = f((static_cast<float>(x) + 0.5f) / static_cast<float>(n),
                                             (static_cast<float>(y) + 0.5f) / static_cast<float>(n));
  });
  return image;
}

int frequencyOf(const Fractal& fractal, int octave) {
  int f = fractal.frequency;
  for (int o = 0; o < octave; ++o) f *= fractal.lacunarity;
  return f;
}

float gradientSum(const Perlin& perlin, const Fractal& fractal, float u, float v) {
  float sum = 0.0f, weight = 1.0f;
  for (int o = 0; o < fractal.octaves; ++o, weight *= fractal.persistence) {
    const int f = frequencyOf(fractal, o);
    const float scale = static_cast<float>(f);
    // Each octave in its own plane of the lattice, off the lattice points' zeros.
    sum += weight * perlin.periodic(u * scale, v * scale, static_cast<float>(o) * 7.0f + 0.5f, {f, f, 256});
  }
  return sum / kPerlinDeviation;
}

}  // namespace

Volume<float> billowVolume(std::uint64_t seed, int n, const Fractal& fractal, float billow) {
  Volume<float> volume(n, n, n, 1);
  const Perlin perlin(hashOf(seed, 1));
  std::vector<Cellular> cells;
  for (int o = 0; o < fractal.octaves; ++o)
    cells.emplace_back(hashOf(seed, 2, o), glm::ivec3(frequencyOf(fractal, o)));
  parallelFor(static_cast<std::size_t>(n) * n, n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row % n), z = static_cast<int>(row / n);
      float* out = &volume.at(0, y, z);
      float weight = 1.0f;
      for (int o = 0; o < fractal.octaves; ++o, weight *= fractal.persistence) {
        const int f = frequencyOf(fractal, o);
        const float step = static_cast<float>(f) / static_cast<float>(n);
        const float py = (static_cast<float>(y) + 0.5f) * step, pz = (static_cast<float>(z) + 0.5f) * step;
        for (int x = 0; x < n; ++x) {
          const float px = (static_cast<float>(x) + 0.5f) * step;
          float v = 0.0f;
          if (billow < 1.0f)
            v += (1.0f - billow) * perlin.periodic(px, py, pz, glm::ivec3(f)) / kPerlinDeviation;
          if (billow > 0.0f) v += billow * (kCellular3Mean - cells[o].f1(px, py, pz)) / kCellular3Deviation;
          out[x] += weight * v;
        }
      }
    }
  });
  normalise(volume.data);
  return volume;
}

Image<float> gaussianMap(std::uint64_t seed, int n, const Fractal& fractal) {
  const Perlin perlin(seed);
  Image<float> map = fillMap(n, [&](float u, float v) { return gradientSum(perlin, fractal, u, v); });
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
  Image<float> map = fillMap(n, [&](float u, float v) {
    float sum = 0.35f * gradientSum(perlin, fractal, u, v), weight = 1.0f;
    for (int o = 0; o < fractal.octaves; ++o, weight *= fractal.persistence) {
      const float f = static_cast<float>(frequencyOf(fractal, o));
      sum += weight * (kCellular2Mean - cells[o].f1(u * f, v * f)) / kCellular2Deviation;
    }
    return sum;
  });
  makeGaussian(map.data);
  return map;
}

}  // namespace welkin::noise
