// SPDX-License-Identifier: Apache-2.0
// What the fills look like in numbers: seams, range, normalisations, spectrum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "welkin/noise/noise.h"

namespace welkin::noise {
namespace {

std::vector<float> filled(const NoiseParams& p, glm::ivec3 size) {
  const Noise noise(p);
  std::vector<float> v(static_cast<std::size_t>(size.x) * size.y * size.z * noise.channels());
  noise.fill(Grid::tile(size), std::span(v));
  return v;
}

struct Moments {
  double mean = 0, deviation = 0, least = 1e9, greatest = -1e9;
};
Moments momentsOf(const std::vector<float>& v) {
  Moments m;
  double squares = 0;
  for (const float x : v) {
    m.mean += x / static_cast<double>(v.size());
    squares += static_cast<double>(x) * x / static_cast<double>(v.size());
    m.least = std::min<double>(m.least, x);
    m.greatest = std::max<double>(m.greatest, x);
  }
  m.deviation = std::sqrt(squares - m.mean * m.mean);
  return m;
}

// Mean absolute difference of neighbours across the edge of the tile and within it, along x.
TEST(Statistics, TilesHaveNoSeam) {
  for (const int dimensions : {2, 3})
    for (const int period : {1, 3, 7, 192, 256, 320, 384, 1536}) {
      NoiseParams p;
      p.dimensions = dimensions;
      p.octaves = 1;
      p.frequency = {period, 61, 61};
      p.seed = 5;
      const int nx = std::max(4 * period, 64);
      const glm::ivec3 size(nx, dimensions == 2 ? 4096 : 64, dimensions == 2 ? 1 : 64);
      const std::vector<float> v = filled(p, size);
      double across = 0.0, inside = 0.0, most = 0.0;
      const int rows = size.y * size.z;
      // The seam's like: columns as far from lattice points as the edge, which lies on one.
      const int cell = nx / period;
      std::vector<double> likes;
      for (int x = 0; x < nx; x += cell) {
        double sum = 0.0;
        for (int r = 0; r < rows; ++r) {
          const float* row = v.data() + static_cast<std::ptrdiff_t>(r) * nx;
          sum += std::abs(row[x] - row[x == 0 ? nx - 1 : x - 1]);
        }
        if (x == 0)
          across = sum / rows;
        else
          likes.push_back(sum / rows);
      }
      if (likes.empty()) {  // one cell: against the steepest place inside
        for (int x = 1; x < nx; ++x) {
          double sum = 0.0;
          for (int r = 0; r < rows; ++r) {
            const float* row = v.data() + static_cast<std::ptrdiff_t>(r) * nx;
            sum += std::abs(row[x] - row[x - 1]);
          }
          most = std::max(most, sum / rows);
        }
        EXPECT_LT(across, 1.2 * most) << period;
        continue;
      }
      for (const double l : likes) inside += l / static_cast<double>(likes.size());
      double spread = 0.0;
      for (const double l : likes) spread += (l - inside) * (l - inside) / static_cast<double>(likes.size());
      EXPECT_NEAR(across, inside, 5.0 * std::sqrt(spread) + 0.12 * inside) << period << " in " << dimensions;
    }
}

TEST(Statistics, UnitVarianceAndUnitRangeAreWhatTheySay) {
  for (const Kind kind : {Kind::kPerlin, Kind::kCellular, Kind::kCurl, Kind::kDistorted, Kind::kValue})
    for (const int dimensions : {2, 3})
      for (const Fractal fractal : {Fractal::kFbm, Fractal::kBillow, Fractal::kRidged}) {
        const bool bends = kind == Kind::kPerlin || kind == Kind::kDistorted || kind == Kind::kValue;
        if (!bends && fractal != Fractal::kFbm) continue;
        NoiseParams p{.kind = kind, .dimensions = dimensions, .octaves = 2, .fractal = fractal, .seed = 3};
        p.frequency = dimensions == 2 ? glm::dvec3(150) : glm::dvec3(21);
        p.normalisation = Normalisation::kUnitVariance;
        const glm::ivec3 size = dimensions == 2 ? glm::ivec3(700, 700, 1) : glm::ivec3(100);
        const Moments m = momentsOf(filled(p, size));
        EXPECT_NEAR(m.mean, 0.0, 0.05) << static_cast<int>(kind) << " " << dimensions;
        EXPECT_NEAR(m.deviation, 1.0, 0.05) << static_cast<int>(kind) << " " << dimensions;
        p.normalisation = Normalisation::kUnitRange;
        const Moments r = momentsOf(filled(p, size));
        EXPECT_GE(r.least, 0.0);
        EXPECT_LE(r.greatest, 1.0);
        EXPECT_GT(r.greatest - r.least, 0.35);
      }
}

// In a plane Perlin's own noise is a plane of his lattice of three axes: less than the lattice has on
// average.
TEST(Statistics, ThePublishedTableHasUnitVarianceInAPlaneToo) {
  for (const Fractal fractal : {Fractal::kFbm, Fractal::kBillow, Fractal::kRidged})
    for (const int octaves : {1, 4}) {
      if (octaves > 1 && fractal != Fractal::kFbm) continue;  // the last has one sample a cell, in its middle
      NoiseParams p{.dimensions = 2, .frequency = glm::dvec3(256), .octaves = octaves, .fractal = fractal};
      p.table = Table::kPublished;
      p.normalisation = Normalisation::kUnitVariance;
      const Moments m = momentsOf(filled(p, {2048, 2048, 1}));
      EXPECT_NEAR(m.mean, 0.0, 0.01) << octaves;
      EXPECT_NEAR(m.deviation, 1.0, 0.01) << octaves;
      p.normalisation = Normalisation::kUnitRange;
      const Moments r = momentsOf(filled(p, {2048, 2048, 1}));
      EXPECT_GE(r.least, 0.0);
      EXPECT_LE(r.greatest, 1.0);
    }
}

// Whatever octaves add up to, integers hold curl noise: of a channel hardly a texel is cut off, and half the
// range is used.
TEST(Statistics, IntegersHoldCurlNoise) {
  for (const int dimensions : {2, 3})
    for (const int octaves : {1, 3, 6, 8})
      for (const double persistence : {0.5, 1.0})
        for (const glm::dvec3 frequency : {glm::dvec3(4), glm::dvec3(4, 16, 2)}) {
          NoiseParams p{.kind = Kind::kCurl, .dimensions = dimensions, .frequency = frequency};
          p.octaves = octaves;
          p.persistence = persistence;
          const Noise noise(p);
          const Grid grid = Grid::tile(dimensions == 2 ? glm::ivec3(250, 250, 1) : glm::ivec3(40));
          const std::size_t texels = static_cast<std::size_t>(grid.size.x) * grid.size.y * grid.size.z;
          std::vector<std::uint8_t> bytes(texels * static_cast<std::size_t>(dimensions));
          noise.fill(grid, std::span(bytes));
          const auto [least, most] = std::minmax_element(bytes.begin(), bytes.end());
          EXPECT_GT(*most - *least, 127) << dimensions << " " << octaves;
          for (int c = 0; c < dimensions; ++c) {
            std::size_t cut = 0;
            for (std::size_t i = static_cast<std::size_t>(c); i < bytes.size(); i += dimensions)
              cut += bytes[i] == 0 || bytes[i] == 255;
            EXPECT_LT(static_cast<double>(cut), 0.001 * static_cast<double>(texels))
                << dimensions << " " << octaves << " " << persistence << " " << frequency.y;
          }
        }
}

// Points move at a cell a unit of time at most on each axis, and so does the distance to them; their
// statistics are the same at every time.
TEST(Statistics, CellularNoiseEvolvesWithoutJumpsOrDrift) {
  for (const int dimensions : {2, 3})
    for (const double time : {-3.2, 0.0, 0.37, 1.0, 17.3, 1e6}) {
      NoiseParams p{
          .kind = Kind::kCellular, .dimensions = dimensions, .frequency = glm::dvec3(32), .octaves = 1};
      const glm::ivec3 size = dimensions == 2 ? glm::ivec3(256, 256, 1) : glm::ivec3(64);
      p.time = time;
      const std::vector<float> now = filled(p, size);
      const Moments m = momentsOf(now);
      EXPECT_NEAR(m.mean, dimensions == 2 ? 0.4296 : 0.5203, 0.01) << time;
      EXPECT_NEAR(m.deviation, dimensions == 2 ? 0.1897 : 0.1723, 0.01) << time;
      for (const double step : {0.1, 1e-3, 1e-5}) {
        p.time = time + step;
        const std::vector<float> then = filled(p, size);
        double most = 0.0;
        for (std::size_t i = 0; i < now.size(); ++i)
          most = std::max(most, std::abs(static_cast<double>(now[i]) - static_cast<double>(then[i])));
        EXPECT_LT(most, std::sqrt(dimensions) * step + 1e-6) << time;
        EXPECT_GT(most, 0.5 * step) << time;
      }
    }
}

// The thesis's formula: clamp(sum a_o (n_o + 1) / 2).
TEST(Statistics, TheThesissNormalisationIsItsFormula) {
  NoiseParams p{.frequency = {6, 6, 6}, .octaves = 6, .amplitude = 0.7};
  const glm::ivec3 size(48, 16, 16);
  const std::vector<float> raw = filled(p, size);
  p.normalisation = Normalisation::kThesis;
  const std::vector<float> thesis = filled(p, size);
  double sum = 0.0;
  for (int o = 0; o < 6; ++o) sum += 0.7 * std::pow(0.5, o);
  int clamped = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const double v = 0.5 * (raw[i] + sum);
    EXPECT_NEAR(thesis[i], std::clamp(v, 0.0, 1.0), 1e-6);
    clamped += v > 1.0;
  }
  EXPECT_GT(clamped, 0);
}

// Discrete Fourier transform of n numbers, `step` apart.
void transform(std::complex<double>* v, int n, int step) {
  std::vector<std::complex<double>> turn(n), out(n);
  for (int i = 0; i < n; ++i) turn[i] = std::polar(1.0, 2.0 * std::numbers::pi * i / n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      out[k] += v[static_cast<std::size_t>(i) * step] * turn[static_cast<std::size_t>(i) * k % n];
  for (int k = 0; k < n; ++k) v[static_cast<std::size_t>(k) * step] = out[k];
}

// Band-limited as far as gradient noise is (R. Cook, T. DeRose 2005, "Wavelet Noise", show how far): the
// power of an octave lies around the lattice's frequency, little below a quarter of it and hardly any beyond
// thrice it.
TEST(Statistics, PerlinNoiseIsBandLimited) {
  const int n = 128, frequency = 16;
  NoiseParams p{.dimensions = 2, .frequency = glm::dvec3(frequency), .octaves = 1};
  double low = 0.0, band = 0.0, high = 0.0, all = 0.0;
  for (p.seed = 0; p.seed < 4; ++p.seed) {
    const std::vector<float> v = filled(p, {n, n, 1});
    std::vector<std::complex<double>> f(v.begin(), v.end());
    for (int i = 0; i < n; ++i) transform(&f[static_cast<std::size_t>(i) * n], n, 1);
    for (int i = 0; i < n; ++i) transform(&f[i], n, n);
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const double k = std::hypot(std::min(x, n - x), std::min(y, n - y)) / frequency;
        const double power = std::norm(f[static_cast<std::size_t>(y) * n + x]);
        all += power;
        if (k < 0.25) low += power;
        if (k > 0.25 && k < 1.5) band += power;
        if (k > 3.0) high += power;
      }
  }
  EXPECT_LT(low / all, 0.04);
  EXPECT_GT(band / all, 0.9);
  EXPECT_LT(high / all, 0.01);
}

// Cellular noise has no preferred direction: neighbours along axes and diagonals correlate by distance alone.
TEST(Statistics, CellsAreIsotropic) {
  NoiseParams p{.kind = Kind::kCellular, .frequency = glm::dvec3(20), .octaves = 1};
  const int n = 120;
  const std::vector<float> v = filled(p, glm::ivec3(n));
  const Moments m = momentsOf(v);
  const auto correlation = [&](glm::ivec3 shift) {
    double sum = 0.0;
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
          const int i = (x + shift.x + n) % n, j = (y + shift.y + n) % n, k = (z + shift.z + n) % n;
          sum += (v[(static_cast<std::size_t>(z) * n + y) * n + x] - m.mean) *
                 (v[(static_cast<std::size_t>(k) * n + j) * n + i] - m.mean);
        }
    return sum / (static_cast<double>(n) * n * n * m.deviation * m.deviation);
  };
  // Five samples, of the six of a cell, in several directions.
  const double along = correlation({5, 0, 0});
  for (const glm::ivec3 shift : {glm::ivec3(0, 5, 0), glm::ivec3(0, 0, 5), glm::ivec3(3, 4, 0),
                                 glm::ivec3(0, -3, 4), glm::ivec3(4, 0, -3), glm::ivec3(3, -4, 0)})
    EXPECT_NEAR(correlation(shift), along, 0.05);
  EXPECT_NEAR(correlation({6, -12, 6}), 0.0, 0.05);  // the shift of a well-known bad hash
}

}  // namespace
}  // namespace welkin::noise
