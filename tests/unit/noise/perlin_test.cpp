// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>

#include "welkin/core/random.h"
#include "welkin/noise/gradient.h"
#include "welkin/noise/lattice.h"
#include "welkin/noise/noise.h"

namespace welkin::noise {
namespace {

NoiseParams published() {
  NoiseParams p;
  p.tile = false;
  p.frequency = glm::dvec3(1.0);
  p.octaves = 1;
  p.table = Table::kPublished;
  return p;
}

glm::dvec3 somewhere(Random& random, double across) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return glm::dvec3(x, y, z) * across;
}

// Values of Perlin's own reference program.
TEST(Perlin, ReproducesThePublishedValues) {
  const Noise noise(published());
  EXPECT_EQ(noise.sample({3.14, 42, 7}), 0.13691995878400012);
  EXPECT_EQ(noise.sample({-4.20, 10, 6}), 0.14208000000000043);
  EXPECT_EQ(noise.sample({0.5, 0.5, 0.5}), -0.25);
  EXPECT_EQ(noise.sample({17, -3, 255}), 0.0);
}

TEST(Perlin, IsTheSameFarFromTheOrigin) {
  const Noise noise(published());
  const double far = 256.0 * 4194304.0;  // where floats cannot even count cells
  EXPECT_NEAR(noise.sample({3.140625 + far, 42.25 - far, 7.5}), noise.sample({3.140625, 42.25, 7.5}), 1e-12);
  NoiseParams p;
  p.tile = false;
  p.frequency = {0.3, 0.7, 0.011};  // no powers of two: products are rounded
  const Noise here(p);
  p.offset = {1e9, -1e9, 3e9};
  const Noise there(p);
  for (const glm::dvec3 q : {glm::dvec3(0.25, 1.5, 3.75), glm::dvec3(-7.125, 0.5, 100.0)})
    EXPECT_NEAR(there.sample(q), here.sample(q + p.offset), 1e-12);
}

// After a whole number of periods all is as it was, what shifts distorted noise's distortion included.
TEST(Noise, IsTheSameAfterManyPeriods) {
  for (const Kind kind :
       {Kind::kPerlin, Kind::kValue, Kind::kCellular, Kind::kPerlinWorley, Kind::kCurl, Kind::kDistorted}) {
    NoiseParams p;
    p.kind = kind;
    p.frequency = {6, 5, 3};
    const Noise here(p);
    p.offset = {1e9, -1e9, 999999999.0};
    const Noise there(p);
    Random random(5);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 q = somewhere(random, 1.0);
      EXPECT_NEAR(there.sample(q), here.sample(q), 1e-12) << "kind " << static_cast<int>(kind);
    }
  }
}

// No seam on any axis, whatever the kind and the period: nothing jumps where the tile ends.
TEST(Noise, IsContinuousAcrossEveryEdge) {
  Random random(6);
  for (const Kind kind :
       {Kind::kPerlin, Kind::kValue, Kind::kCellular, Kind::kPerlinWorley, Kind::kCurl, Kind::kDistorted})
    for (const int dimensions : {2, 3})
      for (const int period : {1, 3, 7, 192, 1536}) {
        NoiseParams p;
        p.kind = kind;
        p.dimensions = dimensions;
        p.octaves = 2;
        for (int axis = 0; axis < dimensions; ++axis) {
          p.frequency = {2, 5, 3};
          p.frequency[axis] = period;
          const Noise of(p);
          for (int i = 0; i < 20; ++i) {
            glm::dvec3 before = somewhere(random, 1.0);
            before[axis] = 1.0 - 1e-9 / period;
            glm::dvec3 behind = before;
            behind[axis] = 1e-9 / period;
            for (int c = 0; c < of.channels(); ++c) {
              const double size = 1.0 + std::abs(of.sample(before, c));
              EXPECT_NEAR(of.sample(before, c), of.sample(behind, c), 1e-6 * size * period)
                  << "kind " << static_cast<int>(kind) << " axis " << axis << " period " << period;
            }
          }
        }
      }
}

// Beyond 2^53 cells, where doubles leave cells out.
TEST(Axis, CountsEveryCellFarAway) {
  const Axis axis(1, 8192.0, 1e15, 0.0);
  for (int i = -500; i < 500; ++i) {
    const std::int64_t cell = std::int64_t{1000000000000000} * 8192 + (i < 0 ? (i - 3) / 4 : i / 4);
    const Span s = axis.at(i / 32768.0);
    EXPECT_EQ(s.low, static_cast<std::uint32_t>(cell)) << i;
    EXPECT_EQ(s.high, static_cast<std::uint32_t>(cell + 1)) << i;
    EXPECT_EQ(s.inside, ((i % 4) + 4) % 4 / 4.0) << i;
  }
}

// A step of rounding farther than integers count, and a product beyond doubles.
TEST(Axis, HasAPlaceHoweverFarAway) {
  const Axis axis(1, 8192.0, 1.0, 0.0);
  for (const double p : {1e25, -1e25, 1e40, -1e40, 1e300, 1e308, -1e308}) {
    const Span s = axis.at(p);
    EXPECT_EQ(s.high, s.low + 1) << p;
    EXPECT_TRUE(s.inside >= 0.0 && s.inside < 1.0) << p;
  }
  // 2^84 + 3 cells, of which the product holds the first alone.
  const double cells = std::ldexp(1.0, 84);
  EXPECT_EQ(Axis(1, 1.0, 0.0, 0.0, 3.0 + 4294967296.0 * 5.0).at(cells).low, 3U);
}

TEST(Perlin, HasTheKnownSpread) {
  for (const int dimensions : {2, 3})
    for (const bool evolving : {false, true}) {
      NoiseParams p;
      p.dimensions = dimensions;
      p.frequency = glm::dvec3(512.0);
      p.octaves = 1;
      p.seed = 7;
      double sum = 0, squares = 0, greatest = 0;
      const int n = 100000;
      Random random(1);
      std::optional<Noise> noise;
      for (int i = 0; i < n; ++i) {
        if (evolving && i % 1000 == 0) p.time = 0.00237 * i;
        if (i % 1000 == 0) noise.emplace(p);
        const double v = noise->sample(somewhere(random, 1.0));
        sum += v;
        squares += v * v;
        greatest = std::max(greatest, std::abs(v));
      }
      const int axes = dimensions + (evolving ? 1 : 0);
      EXPECT_NEAR(sum / n, 0.0, 0.01);
      EXPECT_NEAR(std::sqrt(squares / n), GradientLattice::deviation(axes), 0.01);
      EXPECT_LT(greatest, GradientLattice::bound(axes));
    }
  EXPECT_NEAR(GradientLattice::deviation(3), 0.270, 0.0005);
}

// Nothing of low frequency: over the points of the lattice, and in the mean, the noise is zero.
TEST(Perlin, IsZeroOnTheLattice) {
  NoiseParams p;
  p.frequency = {7, 5, 3};
  p.octaves = 1;
  const Noise noise(p);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(noise.sample({i / 7.0, (i % 5) / 5.0, (i % 3) / 3.0}), 0.0, 1e-14);
}

TEST(Perlin, TilesWithAnyPeriod) {
  Random random(2);
  for (const Kind kind : {Kind::kPerlin, Kind::kCellular, Kind::kDistorted, Kind::kCurl, Kind::kPerlinWorley})
    for (const glm::dvec3 period : {glm::dvec3(1, 1, 1), glm::dvec3(3, 5, 7), glm::dvec3(300, 257, 511)}) {
      NoiseParams p;
      p.kind = kind;
      p.frequency = period;
      p.octaves = 2;
      const Noise noise(p);
      for (int i = 0; i < 20; ++i) {
        // Multiples of 1/64, so that adding a tile is exact.
        const glm::dvec3 q = glm::floor(somewhere(random, 64.0)) / 64.0;
        for (int c = 0; c < noise.channels(); ++c) {
          EXPECT_EQ(noise.sample(q, c), noise.sample(q + glm::dvec3(1, 0, 0), c));
          EXPECT_EQ(noise.sample(q, c), noise.sample(q - glm::dvec3(0, 1, 5), c));
          EXPECT_EQ(noise.sample(q, c), noise.sample(q + glm::dvec3(1e9, 0, 0), c));
        }
      }
    }
}

TEST(Perlin, HasNoSlopeWhereThereIsNoPlace) {
  for (const Kind kind : {Kind::kPerlin, Kind::kValue}) {
    const Noise noise({.kind = kind});
    for (const double nowhere : {HUGE_VAL, -HUGE_VAL, std::nan("")})
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 p(0.25);
        p[axis] = nowhere;
        const Noise::Slope s = noise.sampleSlope(p);
        EXPECT_TRUE(std::isnan(s.value) && std::isnan(s.gradient.x) && std::isnan(s.gradient.z));
      }
  }
}

TEST(Perlin, HasTheSlopesOfFiniteDifferences) {
  Random random(3);
  for (const bool evolving : {false, true}) {
    NoiseParams p;
    p.frequency = {3, 4, 5};
    p.octaves = 3;
    if (evolving) p.time = 0.6;
    const Noise noise(p);
    const double h = 1e-5;
    for (int i = 0; i < 100; ++i) {
      const glm::dvec3 q = somewhere(random, 1.0);
      const Noise::Slope s = noise.sampleSlope(q);
      EXPECT_DOUBLE_EQ(s.value, noise.sample(q));
      for (int a = 0; a < 3; ++a) {
        glm::dvec3 step(0.0);
        step[a] = h;
        EXPECT_NEAR(s.gradient[a], (noise.sample(q + step) - noise.sample(q - step)) / (2 * h), 1e-5);
      }
    }
  }
}

TEST(Curl, IsFreeOfDivergence) {
  Random random(4);
  for (const int dimensions : {2, 3}) {
    NoiseParams p;
    p.kind = Kind::kCurl;
    p.dimensions = dimensions;
    p.frequency = {3, 4, 5};
    p.octaves = 3;
    const Noise noise(p);
    ASSERT_EQ(noise.channels(), dimensions);
    const double h = 1e-5;
    for (int i = 0; i < 100; ++i) {
      const glm::dvec3 q = somewhere(random, 1.0);
      double divergence = 0.0, size = 0.0;
      for (int a = 0; a < dimensions; ++a) {
        glm::dvec3 step(0.0);
        step[a] = h;
        const double slope = (noise.sample(q + step, a) - noise.sample(q - step, a)) / (2 * h);
        divergence += slope;
        size += std::abs(slope);
      }
      EXPECT_NEAR(divergence, 0.0, 1e-5 * (1.0 + size));
    }
  }
}

TEST(Time, IsContinuousAndRepeatsAfterItsPeriod) {
  for (const Kind kind : {Kind::kPerlin, Kind::kValue, Kind::kCellular, Kind::kDistorted})
    for (const int dimensions : {2, 3}) {
      NoiseParams p;
      p.kind = kind;
      p.dimensions = dimensions;
      p.octaves = 2;
      p.timePeriod = 4;
      auto at = [&](double time) {
        p.time = time;
        return Noise(p).sample({0.3, 0.4, 0.7});
      };
      EXPECT_NEAR(at(1.25), at(1.25 + 1e-7), 1e-5);
      EXPECT_NEAR(at(4.0 - 1e-7), at(0.0), 1e-5);
      EXPECT_DOUBLE_EQ(at(0.75), at(4.75));
      EXPECT_NE(at(0.3), at(1.7));
    }
}

TEST(Noise, SeedsDifferAndRepeat) {
  NoiseParams p;
  auto at = [&](std::int64_t seed) {
    p.seed = seed;
    return Noise(p).sample({0.3, 0.4, 0.7});
  };
  EXPECT_NE(at(1), at(2));
  EXPECT_EQ(at(1), at(1));
}

}  // namespace
}  // namespace welkin::noise
