// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/value.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "welkin/core/random.h"
#include "welkin/noise/noise.h"

namespace welkin::noise {
namespace {

constexpr Interpolation kAll[] = {Interpolation::kLinear, Interpolation::kCosine, Interpolation::kCubic};

// By hand for the first two: m = 0 leaves the constant; m = 1 gives n = 8193.
TEST(Value, HashIsTheSourceFormula) {
  const Value noise;
  EXPECT_FLOAT_EQ(noise.hash(0, 0, 0), static_cast<float>(1.0 - 1376312589.0 / 1073741824.0));
  const std::uint64_t n = 8193, bits = (n * (n * n * 15731 + 789221) + 1376312589) & 0x7fffffff;
  EXPECT_FLOAT_EQ(noise.hash(1, 0, 0), static_cast<float>(1.0 - static_cast<double>(bits) / 1073741824.0));
  // With integers of any size, reduced at the end.
  EXPECT_FLOAT_EQ(noise.hash(-1, 2, 3), static_cast<float>(1.0 - 1307409889.0 / 1073741824.0));
  EXPECT_FLOAT_EQ(noise.hash(1000, -2000, 30), static_cast<float>(1.0 - 1330534723.0 / 1073741824.0));
}

TEST(Value, SeedZeroRepeatsUnderTheSourcesShiftAndOthersDoNot) {
  const Value source, seeded({.seed = 1});
  int same = 0;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(source.hash(i + 57, 4, 9), source.hash(i, 5, 9));
    same += seeded.hash(i + 57, 4, 9) == seeded.hash(i, 5, 9);
  }
  EXPECT_EQ(same, 0);
}

TEST(Value, SmoothingAveragesTwentySevenPoints) {
  const Value noise;
  double corners = 0, edges = 0, faces = 0;
  int count[4] = {};
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const int away = std::abs(i) + std::abs(j) + std::abs(k);
        ++count[away];
        (away == 1 ? faces : away == 2 ? edges : corners) += away == 0 ? 0 : noise.hash(5 + i, -3 + j, 8 + k);
      }
  EXPECT_EQ(count[1], 6);
  EXPECT_EQ(count[2], 12);
  EXPECT_EQ(count[3], 8);
  const double expected =
      9.0 / 18 * noise.hash(5, -3, 8) + 4.0 / 18 * faces / 6 + 3.0 / 18 * edges / 12 + 2.0 / 18 * corners / 8;
  EXPECT_NEAR(noise.lattice(5, -3, 8), expected, 1e-7);
}

TEST(Value, InterpolatesAsTheSourceWritesIt) {
  const double x = 0.3, y = 0.6, z = 0.9;
  for (const Interpolation kind : kAll) {
    const Value noise({.interpolation = kind});
    auto blend = [&](auto&& v, double t) {  // v(-1) to v(2)
      if (kind == Interpolation::kLinear) return v(0) * (1 - t) + v(1) * t;
      if (kind == Interpolation::kCosine) {
        const double f = 1 - std::cos(3.14159265358979323846 * t);
        return v(0) * (1 - 0.5 * f) + 0.5 * v(1) * f;
      }
      const double p = (v(2) - v(1)) - (v(-1) - v(0)), q = v(-1) - v(0) - p, r = v(1) - v(-1), s = v(0);
      return p * t * t * t + q * t * t + r * t + s;
    };
    const double expected = blend(
        [&](int k) {
          return blend(
              [&](int j) {
                return blend([&](int i) -> double { return noise.lattice(7 + i, -4 + j, 2 + k); }, x);
              },
              y);
        },
        z);
    EXPECT_NEAR(noise(7 + x, -4 + y, 2 + z), expected, 1e-12);
    EXPECT_NEAR(noise(7, -4, 2), noise.lattice(7, -4, 2), 1e-12) << "passes through the lattice values";
  }
}

TEST(Value, SlopeIsTheDerivative) {
  Random random(3);
  for (const Interpolation kind : kAll) {
    const Value noise({.seed = 5, .interpolation = kind});
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 p(random.uniform() * 50 - 25, random.uniform() * 50, random.uniform() * 50);
      const double h = 1e-6;
      const ValueAndSlope v = noise.withSlope(p.x, p.y, p.z);
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 a = p, b = p;
        a[axis] -= h, b[axis] += h;
        if (std::floor(a[axis]) != std::floor(b[axis])) continue;
        const double expected = (noise(b.x, b.y, b.z) - noise(a.x, a.y, a.z)) / (2 * h);
        EXPECT_NEAR(v.slope[axis], expected, 1e-7);
      }
    }
  }
}

// Cosine and cubic interpolation have no kink where cells meet.
TEST(Value, SlopeIsContinuousAcrossCells) {
  for (const Interpolation kind : {Interpolation::kCosine, Interpolation::kCubic}) {
    const Value noise({.interpolation = kind});
    for (int i = -20; i < 20; ++i)
      EXPECT_NEAR(noise.withSlope(i - 1e-9, 0.3, 0.4).slope.x, noise.withSlope(i + 1e-9, 0.3, 0.4).slope.x,
                  1e-7);
  }
}

TEST(Value, RepeatsWithAnyPeriod) {
  Random random(2);
  for (const glm::ivec3 period : {glm::ivec3(1, 1, 1), glm::ivec3(3, 7, 320), glm::ivec3(192, 0, 1536)})
    for (const Interpolation kind : kAll)
      for (const std::uint64_t seed : {0, 9}) {
        const Value noise({.seed = seed, .interpolation = kind, .period = period});
        for (int i = 0; i < 50; ++i) {
          const double x = random.uniform() * 8 - 4, y = random.uniform() * 8, z = random.uniform() * 8;
          const double shifted = noise(x - period.x, y + 2.0 * period.y, z + period.z);
          EXPECT_NEAR(noise(x, y, z), shifted, 1e-9);
        }
      }
}

// 2^32 cells are a whole turn of the source's 32-bit hash, on every axis.
TEST(Value, IsTheSameFarFromTheOrigin) {
  const double far = 4294967296.0;
  for (const Interpolation kind : kAll) {
    const Value noise({.interpolation = kind});
    EXPECT_NEAR(noise(3.25 + far, 42.5 - far, 7.125), noise(3.25, 42.5, 7.125), 1e-12);
  }
  const Value seeded({.seed = 3, .period = {1000, 1000, 1000}});
  EXPECT_NEAR(seeded(1e9 + 0.25, -1e9 + 0.5, 0.125), seeded(0.25, 0.5, 0.125), 1e-12);
}

TEST(Value, GridAgreesWithThePointFunction) {
  // Finer and coarser than the lattice, far away, across the origin, one sample.
  const SampleBox boxes[] = {{{0.5, 0.25, 0.1}, glm::dvec3(1.0 / 12), {0, 0, 0}, {31, 9, 14}},
                             {{-2.0, -1.5, -0.5}, {0.37, 0.9, 1.7}, {0, 0, 0}, {17, 8, 5}},
                             {{0.0, 0.0, 0.0}, {57.3, 4.0, 11.5}, {3, -4, 5}, {9, 7, 6}},
                             {{1e9 + 0.5, -1e9, 12345.75}, glm::dvec3(0.11), {-7, 0, 100}, {12, 5, 4}},
                             {{0.5, 0.5, 0.5}, glm::dvec3(1.0), {0, 0, 0}, {1, 1, 1}}};
  for (const Interpolation kind : kAll)
    for (const bool smooth : {false, true})
      for (const glm::ivec3 period : {glm::ivec3(0), glm::ivec3(4, 7, 5)}) {
        const Value noise({.seed = 0, .interpolation = kind, .smooth = smooth, .period = period});
        for (const SampleBox& box : boxes) {
          std::vector<float> out(static_cast<std::size_t>(box.count.x) * box.count.y * box.count.z, 1.0f);
          noise.add(out, 0.5f, box);
          std::size_t n = 0;
          for (int k = 0; k < box.count.z; ++k)
            for (int j = 0; j < box.count.y; ++j)
              for (int i = 0; i < box.count.x; ++i, ++n) {
                const double v = noise(box.position(0, i), box.position(1, j), box.position(2, k));
                ASSERT_NEAR(out[n], 1.0 + 0.5 * v, 1e-6) << i << " " << j << " " << k;
              }
        }
      }
}

TEST(Value, ASubBoxHasTheSameBits) {
  for (const Interpolation kind : kAll) {
    const Value noise({.seed = 4, .interpolation = kind, .period = {5, 5, 5}});
    const SampleBox whole{{0.3, 0.3, 0.3}, {0.21, 0.33, 0.47}, {0, 0, 0}, {24, 16, 10}};
    std::vector<float> all(24 * 16 * 10);
    noise.add(all, 1.0f, whole);
    SampleBox part = whole;
    part.begin = {5, 3, 4};
    part.count = {7, 6, 2};
    std::vector<float> some(7 * 6 * 2);
    noise.add(some, 1.0f, part);
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 7; ++i)
          ASSERT_EQ(some[(k * 6 + j) * 7 + i], all[((k + 4) * 16 + j + 3) * 24 + i + 5]);
  }
}

// Bare: 1/3 times the mean square weight (2/3 linear, 3/4 cosine) to the third, under the root.
TEST(Value, HasTheSpreadOfItsDescription) {
  struct Case {
    Interpolation kind;
    bool smooth;
    double deviation, bound;
  };
  for (const Case& c :
       {Case{Interpolation::kLinear, false, std::sqrt(8.0 / 81), 1.0},
        Case{Interpolation::kCosine, false, std::sqrt(27.0 / 192), 1.0},
        Case{Interpolation::kCubic, false, 0.498, 2.0}, Case{Interpolation::kLinear, true, 0.185, 1.0},
        Case{Interpolation::kCosine, true, 0.211, 1.0}, Case{Interpolation::kCubic, true, 0.272, 1.2}})
    for (const std::uint64_t seed : {0, 1}) {
      const Value noise({.seed = seed, .interpolation = c.kind, .smooth = c.smooth});
      const int n = 64;
      std::vector<float> v(n * n * n);
      noise.add(v, 1.0f, {glm::dvec3(0.123), glm::dvec3(0.77), glm::ivec3(0), glm::ivec3(n)});
      double sum = 0, squares = 0, greatest = 0;
      for (const float x : v) sum += x, squares += x * x, greatest = std::max<double>(greatest, std::abs(x));
      const double mean = sum / static_cast<double>(v.size());
      EXPECT_NEAR(mean, 0.0, 0.003);
      EXPECT_NEAR(std::sqrt(squares / static_cast<double>(v.size()) - mean * mean), c.deviation, 0.005);
      EXPECT_NEAR(noise.deviation(3), c.deviation, 0.003);
      EXPECT_LE(greatest, noise.bound(3));
      EXPECT_LE(greatest, c.bound);
    }
}

NoiseParams sumOfThree(int dimensions, Fractal fractal) {
  NoiseParams p;
  p.kind = Kind::kValue;
  p.dimensions = dimensions;
  p.frequency = {3, 5, 4};
  p.octaves = 3;
  p.fractal = fractal;
  return p;
}

TEST(ValueSum, GridAgreesWithThePointFunctionAndTiles) {
  for (const int dimensions : {2, 3})
    for (const Fractal fractal : {Fractal::kFbm, Fractal::kBillow, Fractal::kRidged}) {
      NoiseParams p = sumOfThree(dimensions, fractal);
      p.offset = {1e9 + 0.25, -0.125, 7};
      const Noise noise(p);
      const Grid grid = Grid::tile({40, 70, dimensions == 3 ? 20 : 1});
      std::vector<float> all(static_cast<std::size_t>(grid.size.x) * grid.size.y * grid.size.z);
      noise.fill(grid, std::span(all));
      const Box part{{3, 60, dimensions == 3 ? 15 : 0}, {9, 8, dimensions == 3 ? 4 : 1}};
      std::vector<float> some(static_cast<std::size_t>(part.size.x) * part.size.y * part.size.z);
      noise.fill(grid, part, std::span(some));
      std::size_t n = 0;
      for (int z = 0; z < part.size.z; ++z)
        for (int y = 0; y < part.size.y; ++y)
          for (int x = 0; x < part.size.x; ++x, ++n) {
            const glm::ivec3 i = part.first + glm::ivec3(x, y, z);
            ASSERT_EQ(some[n], all[(static_cast<std::size_t>(i.z) * grid.size.y + i.y) * grid.size.x + i.x]);
            const glm::dvec3 at = (glm::dvec3(i) + 0.5) * grid.spacing;
            ASSERT_NEAR(some[n], noise.sample(at), 2e-6);
            ASSERT_NEAR(noise.sample(at), noise.sample(at + glm::dvec3(1, -2, 1)), 1e-9);
          }
    }
}

// Its measure is the infinite lattice, so that a tile of one cell is as any other.
TEST(ValueSum, BentHasTheSpreadOfTheInfiniteLattice) {
  for (const Fractal fractal : {Fractal::kBillow, Fractal::kRidged}) {
    NoiseParams p{.kind = Kind::kValue, .frequency = {1, 1, 1}, .octaves = 1, .fractal = fractal};
    p.normalisation = Normalisation::kUnitVariance;
    p.smooth = false;
    for (p.seed = 0; p.seed < 5; ++p.seed) EXPECT_LT(std::abs(Noise(p).sample({0.3, 0.4, 0.5})), 6.0);
  }
}

TEST(ValueSum, HasSlopesAndNormalisations) {
  NoiseParams p = sumOfThree(3, Fractal::kFbm);
  const Noise noise(p);
  const glm::dvec3 at(0.3, 0.7, 0.2);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 a = at, b = at;
    a[axis] -= 1e-7, b[axis] += 1e-7;
    EXPECT_NEAR(noise.sampleSlope(at).gradient[axis], (noise.sample(b) - noise.sample(a)) / 2e-7, 1e-5);
  }
  for (const int dimensions : {2, 3}) {
    p = sumOfThree(dimensions, Fractal::kFbm);
    p.frequency = {61, 61, 61};
    p.octaves = 1;
    p.normalisation = Normalisation::kUnitVariance;
    const Grid grid = Grid::tile({256, 256, dimensions == 3 ? 64 : 1});
    std::vector<float> v(static_cast<std::size_t>(256 * 256) * grid.size.z);
    Noise(p).fill(grid, std::span(v));
    double squares = 0;
    for (const float x : v) squares += x * x;
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(v.size())), 1.0, 0.02) << dimensions;
  }
  // The paper's own noise: the source's hash, every octave.
  p = sumOfThree(3, Fractal::kFbm);
  p.table = Table::kPublished;
  p.tile = false;
  p.frequency = glm::dvec3(1.0);
  const Value source;
  const double expected =
      source(2.3, 4.1, 9.7) + 0.5 * source(4.6, 8.2, 19.4) + 0.25 * source(9.2, 16.4, 38.8);
  EXPECT_NEAR(Noise(p).sample({2.3, 4.1, 9.7}), expected, 1e-9);
}

}  // namespace
}  // namespace welkin::noise
