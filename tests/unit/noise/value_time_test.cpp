// SPDX-License-Identifier: Apache-2.0
// Value noise that evolves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "welkin/core/random.h"
#include "welkin/noise/noise.h"
#include "welkin/noise/value.h"
#include "welkin/noise/value_hash.h"

namespace welkin::noise {
namespace {

constexpr Interpolation kAll[] = {Interpolation::kLinear, Interpolation::kCosine, Interpolation::kCubic};

Value at(ValueSettings settings, double time) {
  const double cell = std::floor(time);
  settings.time = CellPlace{static_cast<std::int64_t>(cell), time - cell};
  return Value(settings);
}

NoiseParams evolving(int dimensions, Interpolation interpolation, bool smooth) {
  NoiseParams p{.kind = Kind::kValue, .dimensions = dimensions, .frequency = {3, 5, 4}, .octaves = 3};
  p.interpolation = interpolation;
  p.smooth = smooth;
  p.time = 0.0;
  return p;
}

struct Moments {
  double mean, deviation;
};
Moments momentsOf(const std::vector<float>& v) {
  double sum = 0.0, squares = 0.0;
  for (const float x : v) sum += x, squares += static_cast<double>(x) * x;
  const double mean = sum / static_cast<double>(v.size());
  return {mean, std::sqrt(squares / static_cast<double>(v.size()) - mean * mean)};
}

std::vector<float> filled(const NoiseParams& p, glm::ivec3 size) {
  std::vector<float> v(static_cast<std::size_t>(size.x) * size.y * size.z);
  Noise(p).fill(Grid::tile(size), std::span(v));
  return v;
}

// As in space (Value.InterpolatesAsTheSourceWritesIt), from the hashes of whole times alone.
TEST(ValueTime, ALatticePointPassesThroughItsWholeTimesAndIsInterpolatedBetween) {
  constexpr std::uint64_t kSeed = 11;
  constexpr int kEach = 50, kPoints = kEach * kTimePhases;
  for (const Interpolation kind : kAll) {
    const ValueSettings bare{.seed = kSeed, .interpolation = kind, .smooth = false};
    const auto whole = [&](int time, int i) {  // the hash of point i in the noise of a whole time
      return static_cast<double>(
          Value({.seed = timeSeed(kSeed, static_cast<std::uint32_t>(time))}).hash(i, -i, 3 * i));
    };
    std::array<int, kTimePhases> points{};
    for (int i = 0; i < kPoints; ++i) {
      int found = -1;
      for (int phase = 0; phase < kTimePhases; ++phase) {
        const double early = static_cast<double>(phase) / kTimePhases;
        if (at(bare, 7 - early).hash(i, -i, 3 * i) == whole(7, i)) found = phase;
      }
      ASSERT_GE(found, 0);
      ++points[static_cast<std::size_t>(found)];
      const double t = 0.3;
      const auto v = [&](int step) { return whole(7 + step, i); };
      double expected = v(0) * (1 - t) + v(1) * t;
      if (kind == Interpolation::kCosine) {
        const double f = 0.5 * (1 - std::cos(std::numbers::pi * t));
        expected = v(0) * (1 - f) + v(1) * f;
      } else if (kind == Interpolation::kCubic) {
        const double p = (v(2) - v(1)) - (v(-1) - v(0)), q = v(-1) - v(0) - p, r = v(1) - v(-1);
        expected = p * t * t * t + q * t * t + r * t + v(0);
      }
      EXPECT_NEAR(at(bare, 7 - static_cast<double>(found) / kTimePhases + t).hash(i, -i, 3 * i), expected,
                  1e-6);
    }
    for (const int n : points) EXPECT_NEAR(n, kEach, 30);  // 4.4 deviations
  }
}

TEST(ValueTime, SmoothingAveragesPointsOfTheSameTime) {
  const Value noise = at({.seed = 3}, 4.4);
  double sum = 0.0;
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        constexpr double kWeight[] = {9.0 / 18, 4.0 / 18 / 6, 3.0 / 18 / 12, 2.0 / 18 / 8};
        sum += kWeight[std::abs(i) + std::abs(j) + std::abs(k)] * noise.hash(5 + i, -3 + j, 8 + k);
      }
  EXPECT_NEAR(noise.lattice(5, -3, 8), sum, 1e-7);
}

TEST(ValueTime, IsContinuousAndRepeatsExactly) {
  for (const Interpolation kind : kAll)
    for (const int dimensions : {2, 3})
      for (const bool smooth : {false, true}) {
        NoiseParams p = evolving(dimensions, kind, smooth);
        p.timePeriod = 3;
        const glm::dvec3 place(0.31, 0.42, 0.73);
        const auto sample = [&](double time) {
          p.time = time;
          return Noise(p).sample(place);
        };
        // Wherever points meet whole times in some octave: sixteenths of a quarter, around the end of the
        // period too.
        for (int n = -8; n <= 200; ++n)
          ASSERT_NEAR(sample(n / 64.0 - 1e-9), sample(n / 64.0 + 1e-9), 1e-6) << n;
        for (const double time : {0.0, 0.3, 1.71875, 2.99}) {
          EXPECT_EQ(sample(std::floor(time * 64) / 64), sample(std::floor(time * 64) / 64 + 3.0));
          EXPECT_NEAR(sample(time), sample(time - 3.0), 1e-9);
          EXPECT_NEAR(sample(time), sample(time + 999999999.0), 1e-5);  // the sum is rounded to 1e-7
        }
        // Not by chance the same in all of several places.
        const auto change = [&](double from, double to) {
          double most = 0.0;
          for (int i = 0; i < 8; ++i) {
            const glm::dvec3 q = place + 0.1 * i;
            p.time = from;
            const double before = Noise(p).sample(q);
            p.time = to;
            most = std::max(most, std::abs(Noise(p).sample(q) - before));
          }
          return most;
        };
        EXPECT_GT(change(0.375, 1.375), 0.05);
        EXPECT_GT(change(0.375, 0.5), 0.02);
        EXPECT_EQ(change(0.375, 3.375), 0.0);
        p.timePeriod = 0;
        EXPECT_GT(change(0.375, 3.375), 0.05);
        EXPECT_GT(change(1e9, 1e9 + 1), 0.05);
      }
}

TEST(ValueTime, OctavesHavePacesOfTheirOwn) {
  NoiseParams one = evolving(3, Interpolation::kCosine, true), two = one;
  one.octaves = 1;
  two.octaves = 2;
  const glm::dvec3 place(0.31, 0.42, 0.73);
  const auto second = [&](double time, double lacunarity) {
    one.time = two.time = time;
    one.timeLacunarity = two.timeLacunarity = lacunarity;
    return Noise(two).sample(place) - Noise(one).sample(place);
  };
  EXPECT_NEAR(second(0.3, 4.0), second(0.6, 2.0), 1e-12);
  EXPECT_NEAR(second(0.3, 0.0), second(7.1, 0.0), 1e-12);
  EXPECT_GT(std::abs(second(0.3, 1.0) - second(0.6, 1.0)), 1e-3);
}

// Neither weaker nor slower at any time: what a phase for every lattice point is for.
TEST(ValueTime, HasTheSameSpreadAndSpeedAtAnyTime) {
  for (const Interpolation kind : kAll)
    for (const int dimensions : {2, 3})
      for (const bool smooth : {false, true}) {
        NoiseParams p = evolving(dimensions, kind, smooth);
        p.octaves = 1;
        p.frequency = dimensions == 2 ? glm::dvec3(149) : glm::dvec3(29);
        const glm::ivec3 size = dimensions == 2 ? glm::ivec3(400, 400, 1) : glm::ivec3(80);
        const double expected =
            at({.seed = 1, .interpolation = kind, .smooth = smooth}, 0.0).deviation(dimensions);
        std::vector<double> speeds;
        for (const double time : {0.0, 0.25, 0.5, 0.71, 3.0, 1e9 + 0.5}) {
          p.time = time;
          std::vector<float> v = filled(p, size);
          const Moments m = momentsOf(v);
          EXPECT_NEAR(m.mean, 0.0, 0.01) << time;
          EXPECT_NEAR(m.deviation, expected, 0.02 * expected) << time << " in " << dimensions;
          p.time = time + 0.01;
          const std::vector<float> next = filled(p, size);
          for (std::size_t i = 0; i < v.size(); ++i) v[i] = (next[i] - v[i]) / 0.01f;
          speeds.push_back(momentsOf(v).deviation);
        }
        const auto [least, most] = std::minmax_element(speeds.begin(), speeds.end());
        EXPECT_LT(*most, 1.08 * *least) << dimensions << " " << smooth;
        EXPECT_GT(*least, expected);  // cells of time are passed in about 1
      }
}

// Linear and cosine: 1/3 times the mean square weight (2/3, 3/4) to the fourth, under the root.
TEST(ValueTime, HasTheSpreadOfItsDescription) {
  struct Case {
    Interpolation kind;
    double deviation, bound;
  };
  for (const Case& c : {Case{Interpolation::kLinear, std::sqrt(16.0 / 243), 1.0},
                        Case{Interpolation::kCosine, std::sqrt(81.0 / 768), 1.0},
                        Case{Interpolation::kCubic, 0.95 * 0.498, 5.0625}}) {
    const Value noise = at({.seed = 1, .interpolation = c.kind, .smooth = false}, 0.6);
    EXPECT_NEAR(noise.deviation(3), c.deviation, 0.002);
    EXPECT_DOUBLE_EQ(noise.bound(3), c.bound);
  }
}

TEST(ValueTime, NormalisationsAreWhatTheySay) {
  for (const int dimensions : {2, 3})
    for (const Fractal fractal : {Fractal::kFbm, Fractal::kBillow, Fractal::kRidged})
      for (const Interpolation kind : kAll)
        for (const double time : {0.0, 0.53}) {
          NoiseParams p = evolving(dimensions, kind, kind == Interpolation::kCosine);
          p.octaves = 2;
          p.fractal = fractal;
          p.frequency = dimensions == 2 ? glm::dvec3(150) : glm::dvec3(21);
          p.time = time;
          p.normalisation = Normalisation::kUnitVariance;
          const glm::ivec3 size = dimensions == 2 ? glm::ivec3(700, 700, 1) : glm::ivec3(100);
          const Moments m = momentsOf(filled(p, size));
          EXPECT_NEAR(m.mean, 0.0, 0.05) << time << " in " << dimensions;
          EXPECT_NEAR(m.deviation, 1.0, 0.05) << time << " in " << dimensions;
          p.normalisation = Normalisation::kUnitRange;
          const std::vector<float> v = filled(p, size);
          const auto [least, greatest] = std::minmax_element(v.begin(), v.end());
          EXPECT_GT(*least, 0.0f);
          EXPECT_LT(*greatest, 1.0f);
          EXPECT_GT(*greatest - *least, 0.25f);
        }
}

TEST(ValueTime, HasTheSlopesOfFiniteDifferencesAndTiles) {
  Random random(6);
  for (const Interpolation kind : kAll)
    for (const int dimensions : {2, 3})
      for (const bool smooth : {false, true}) {
        NoiseParams p = evolving(dimensions, kind, smooth);
        p.time = 0.37;
        const Noise noise(p);
        const double h = 1e-7;
        for (int i = 0; i < 10; ++i) {
          const glm::dvec3 q(random.uniform(), random.uniform(), random.uniform());
          const Noise::Slope s = noise.sampleSlope(q);
          EXPECT_DOUBLE_EQ(s.value, noise.sample(q));
          EXPECT_NEAR(noise.sample(q), noise.sample(q + glm::dvec3(1, -2, 1)), 1e-9);
          for (int axis = 0; axis < dimensions; ++axis) {
            glm::dvec3 a = q, b = q;
            a[axis] -= h, b[axis] += h;
            EXPECT_NEAR(s.gradient[axis], (noise.sample(b) - noise.sample(a)) / (2 * h), 1e-5);
          }
        }
      }
}

// The source's noise has three axes: in a plane its third is time.
TEST(ValueTime, OfThePublishedTableIsTheSourcesThirdAxis) {
  NoiseParams p = evolving(2, Interpolation::kCosine, true);
  p.table = Table::kPublished;
  p.tile = false;
  p.frequency = glm::dvec3(1.0);
  p.time = 9.7;
  const Value source;
  const double expected =
      source(2.3, 4.1, 9.7) + 0.5 * source(4.6, 8.2, 19.4) + 0.25 * source(9.2, 16.4, 38.8);
  EXPECT_NEAR(Noise(p).sample({2.3, 4.1, 0.0}), expected, 1e-9);
  p.timePeriod = 5;
  p.time = 0.25;
  const double once = Noise(p).sample({2.3, 4.1, 0.0});
  p.time = 5.25;
  EXPECT_EQ(Noise(p).sample({2.3, 4.1, 0.0}), once);
  // In the mean over times.
  p.frequency = glm::dvec3(150);
  p.timePeriod = 0;
  p.octaves = 1;
  p.normalisation = Normalisation::kUnitVariance;
  double squares = 0.0;
  for (int frame = 0; frame < 16; ++frame) {
    p.time = (frame + 0.5) / 16;
    const double d = momentsOf(filled(p, {200, 200, 1})).deviation;
    squares += d * d / 16;
  }
  EXPECT_NEAR(std::sqrt(squares), 1.0, 0.03);
}

}  // namespace
}  // namespace welkin::noise
