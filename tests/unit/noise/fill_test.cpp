// SPDX-License-Identifier: Apache-2.0
// The grid fills against the point function, and against themselves: instruction sets, threads, boxes.
#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "welkin/core/parallel.h"
#include "welkin/noise/fill.h"
#include "welkin/noise/noise.h"

namespace {

std::atomic<long> gAllocations{0};
std::atomic<std::size_t> gMost{std::numeric_limits<std::size_t>::max()};  // bytes; more are refused

void* counted(std::size_t size, std::size_t alignment) {
  ++gAllocations;
  if (size > gMost) throw std::bad_alloc();
  void* p = alignment <= alignof(std::max_align_t)
                ? std::malloc(size)
                : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

}  // namespace

// Replaced for the whole program, to count. Not inlined, since g++ would see memory of `new` given to free().
[[gnu::noinline]] void* operator new(std::size_t size) {
  return counted(size, 1);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace welkin::noise {
namespace {

struct Case {
  std::string name;
  NoiseParams params;
  Grid grid;
  double tolerance = 2e-6;
};

// Every kind, dimension, evolution and way to sum, tiled and not, here and far away.
std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name, NoiseParams p, double tolerance = 2e-6) {
    for (const int dimensions : {2, 3})
      for (const bool evolving : {false, true})
        for (const bool tile : {false, true}) {
          if (p.table == Table::kPublished && dimensions == 3 && evolving) continue;
          p.dimensions = dimensions;
          p.tile = tile;
          p.frequency = tile ? glm::dvec3(3, 5, 2) : glm::dvec3(0.11, 0.13, 0.3);
          p.offset = evolving ? glm::dvec3(1e9, -1e9, 0.37) : glm::dvec3(0.0);
          p.time = evolving ? std::optional<double>(0.4) : std::nullopt;
          p.seed = 7;
          const glm::ivec3 size(70, 29, dimensions == 3 ? 13 : 1);
          all.push_back({name + " " + std::to_string(dimensions) + (evolving ? " evolving" : "") +
                             (tile ? " tile" : ""),
                         p, tile ? Grid::tile(size) : Grid{size, glm::dvec3(1.0)}, tolerance});
        }
  };
  for (const Fractal f : {Fractal::kFbm, Fractal::kBillow, Fractal::kRidged}) {
    const std::string bent = f == Fractal::kFbm ? "" : f == Fractal::kBillow ? " billow" : " ridged";
    add("perlin" + bent, {.octaves = 3, .fractal = f});
    add("distorted" + bent, {.kind = Kind::kDistorted, .octaves = 3, .fractal = f},
        f == Fractal::kFbm ? 2e-6 : 8e-6);  // a ridge is four times as steep
  }
  add("published", {.octaves = 3, .table = Table::kPublished});
  add("published value", {.kind = Kind::kValue, .octaves = 3, .table = Table::kPublished});
  for (const Fractal f : {Fractal::kFbm, Fractal::kRidged})
    add("value", {.kind = Kind::kValue, .octaves = 3, .fractal = f}, f == Fractal::kFbm ? 2e-6 : 6e-6);
  for (const Feature f : {Feature::kF1, Feature::kF2, Feature::kF2MinusF1}) {
    add("cells", {.kind = Kind::kCellular, .octaves = 3, .feature = f});
    add("one cells", {.kind = Kind::kCellular, .octaves = 1, .feature = f});
  }
  add("perlin-worley", {.kind = Kind::kPerlinWorley, .octaves = 3});
  add("curl", {.kind = Kind::kCurl, .octaves = 3}, 6e-6);  // values to 10
  add("variance", {.octaves = 3, .normalisation = Normalisation::kUnitVariance});
  // Cells smaller than vectors, and smaller than samples.
  NoiseParams dense{.kind = Kind::kCellular, .frequency = {9, 9, 9}, .octaves = 1};
  all.push_back({"dense", dense, Grid::tile({36, 30, 20})});
  dense.frequency = {40, 40, 40};
  all.push_back({"tiny", dense, Grid::tile({36, 30, 20})});
  // Octaves whose tiles are cut into cubes, the second added to the first.
  NoiseParams cubes{.kind = Kind::kCellular, .frequency = {4, 4, 4}, .octaves = 2};
  all.push_back({"cubes", cubes, Grid::tile({36, 34, 35})});
  // Vectors of 16 samples that begin and end on lattice points.
  all.push_back({"ends on points", {.frequency = {140, 3, 2}, .octaves = 1}, Grid::tile({150, 29, 13})});
  // Lattice points less and more than a sample apart, near the step up to which a vector holds all of them.
  for (const double x : {46.0, 59.0, 65.0})
    for (const bool evolving : {false, true}) {
      NoiseParams fine{.frequency = {x, 20, 9}, .octaves = 2};
      if (evolving) fine.time = 0.7;
      all.push_back(
          {"fine " + std::to_string(x) + (evolving ? " evolving" : ""), fine, Grid::tile({70, 29, 13})});
    }
  return all;
}

template <class T>
std::vector<T> filled(const Noise& noise, const Grid& grid, const Box& box) {
  std::vector<T> out(static_cast<std::size_t>(box.size.x) * box.size.y * box.size.z * noise.channels());
  noise.fill(grid, box, std::span(out));
  return out;
}
template <class T>
std::vector<T> filled(const Noise& noise, const Grid& grid) {
  return filled<T>(noise, grid, {glm::ivec3(0), grid.size});
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

std::vector<std::int64_t> targets(bool fused) {
  std::vector<std::int64_t> all;
  for (const std::int64_t t : hwy::SupportedAndGeneratedTargets())
    if (!fused || (t & (HWY_AVX2 | HWY_AVX3 | HWY_NEON)) != 0) all.push_back(t);
  return all;
}

// Every so many values of a box by the point function.
std::vector<double> exactly(const Noise& noise, const Grid& grid, const Box& box, std::size_t every) {
  const auto channels = static_cast<std::size_t>(noise.channels());
  const std::size_t count = static_cast<std::size_t>(box.size.x) * box.size.y * box.size.z * channels;
  std::vector<double> exact;
  for (std::size_t i = 0; i < count; i += every) {
    const auto sample = static_cast<int>(i / channels), row = sample / box.size.x;
    const glm::dvec3 place(box.first + glm::ivec3(sample % box.size.x, row % box.size.y, row / box.size.y));
    exact.push_back(noise.sample((place + 0.5) * grid.spacing, static_cast<int>(i % channels)));
  }
  return exact;
}

TEST(Fill, AgreesWithThePointFunctionOnEveryInstructionSet) {
  for (const Case& c : cases()) {
    const Noise noise(c.params);
    const auto expectOn = [&](const std::vector<std::int64_t>& sets, const Box& box, std::size_t every) {
      const std::vector<double> exact = exactly(noise, c.grid, box, every);
      for (const std::int64_t target : sets) {
        hwy::SetSupportedTargetsForTest(target);
        const std::vector<float> values = filled<float>(noise, c.grid, box);
        double worst = 0.0;
        for (std::size_t i = 0; i < exact.size(); ++i)
          worst = std::max(worst, std::abs(exact[i] - values[every * i]));
        EXPECT_LE(worst, c.tolerance) << c.name << " " << hwy::TargetName(target);
      }
      hwy::SetSupportedTargetsForTest(0);
    };
    // Without vectors the fill is the point function, but for value noise: a corner shows that.
    std::vector<std::int64_t> vectors = targets(false);
    std::erase(vectors, HWY_SCALAR);
    expectOn(vectors, {glm::ivec3(0), c.grid.size}, 11);
    expectOn({HWY_SCALAR}, {glm::ivec3(0), glm::min(c.grid.size, glm::ivec3(9, 4, 2))}, 1);
  }
}

// Values of curl noise are in cells along x: large where those along y are far smaller.
TEST(Fill, OfCurlAgreesToAFractionOfItsGreatestValueHoweverFar) {
  for (const double far : {0.0, 1e9, 1e15})
    for (const int dimensions : {2, 3}) {
      NoiseParams p{.kind = Kind::kCurl, .dimensions = dimensions, .tile = false, .octaves = 4};
      p.lacunarity = 1.86;
      p.frequency = {0.055, 44.8, 0.097};
      p.offset = {0.68 * far, -0.74 * far, 0.25 * far};
      const Noise noise(p);
      const Grid grid{{57, 11, dimensions == 3 ? 3 : 1}, glm::dvec3(0.0353)};
      const std::vector<float> values = filled<float>(noise, grid);
      double worst = 0.0, greatest = 0.0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const auto sample = static_cast<int>(i / static_cast<std::size_t>(dimensions));
        const glm::dvec3 place(sample % 57, sample / 57 % 11, sample / 57 / 11);
        const double exact = noise.sample((place + 0.5) * grid.spacing, static_cast<int>(i % dimensions));
        worst = std::max(worst, std::abs(exact - values[i]));
        greatest = std::max(greatest, std::abs(exact));
      }
      EXPECT_GT(greatest, 500.0);
      EXPECT_LE(worst, 2e-6 * greatest) << "offset " << far << ", dimensions " << dimensions;
    }
}

TEST(Fill, IsTheSameOnEveryInstructionSetThatFuses) {
  if (targets(true).size() < 2) GTEST_SKIP() << "this processor has one instruction set that fuses";
  for (const Case& c : cases()) {
    const Noise noise(c.params);
    std::vector<std::vector<float>> results;
    for (const std::int64_t target : targets(true)) {
      hwy::SetSupportedTargetsForTest(target);
      results.push_back(filled<float>(noise, c.grid));
    }
    hwy::SetSupportedTargetsForTest(0);
    for (const auto& r : results) EXPECT_TRUE(sameBytes(results[0], r)) << c.name;
  }
}

// Samples that lie on lattice points but for an error of rounding. Products of floats too small to be normal
// take many processors a hundred times as long: fBm at 0.05 cells a sample was twenty times slower for it.
TEST(Fill, HasNoWeightsWhoseProductsAreNotNormalFloats) {
  std::vector<double> inside;
  for (int e = -300; e < 0; ++e)
    for (const double t : {std::pow(10.0, e / 10.0), 1.0 - std::pow(10.0, e / 10.0)})
      if (t < 1.0) inside.push_back(t);
  inside.resize((inside.size() + 7) / 8 * 8, 0.5);
  const int n = static_cast<int>(inside.size());
  for (const bool derivative : {false, true}) {
    std::vector<float> corner[4];
    for (auto& c : corner) c.resize(inside.size());
    makeCorners(inside.data(), n, derivative,
                {corner[0].data(), corner[1].data(), corner[2].data(), corner[3].data()});
    int zeros = 0;
    for (const auto& c : corner)
      for (const float w : c) {
        zeros += w == 0.0f ? 1 : 0;
        EXPECT_TRUE(w == 0.0f || std::isnormal(w * w * w)) << w;
      }
    EXPECT_GT(zeros, 0);
    // What is left out is nothing to a sum.
    for (int i = 0; i < n && !derivative; ++i)
      EXPECT_NEAR(corner[2][i], fade(inside[i]), 1e-12 + 1e-7 * fade(inside[i]));
  }
}

// Value noise fuses nothing. Cells wider and narrower than vectors of samples, and than samples.
TEST(Fill, OfValuesIsTheSameOnEveryInstructionSetAndInEveryPart) {
  for (const double cells : {0.01, 0.3, 0.85, 0.95, 1.5, 2.5, 30.0})
    for (const auto& [interpolation, evolving] :
         {std::pair(Interpolation::kCosine, false), std::pair(Interpolation::kCosine, true),
          std::pair(Interpolation::kCubic, false), std::pair(Interpolation::kCubic, true)})
      for (const Table table : {Table::kSeeded, Table::kPublished})
        for (const bool smooth : {false, true}) {
          NoiseParams p{.kind = Kind::kValue, .tile = false, .frequency = {cells, cells, 0.6}, .octaves = 2};
          if (evolving && table == Table::kPublished) continue;
          if (evolving) p.time = 0.7;
          p.interpolation = interpolation;
          p.smooth = smooth;
          p.table = table;
          p.offset = {-3.3, 0.0, 1e9};
          const Noise noise(p);
          const Grid grid{{301, 35, 4}, glm::dvec3(1.0)};
          std::vector<std::vector<float>> results;
          for (const std::int64_t target : targets(false)) {
            hwy::SetSupportedTargetsForTest(target);
            results.push_back(filled<float>(noise, grid));
          }
          hwy::SetSupportedTargetsForTest(0);
          for (const auto& r : results) ASSERT_TRUE(sameBytes(results[0], r)) << cells << " " << smooth;
          const Box box{{17, 3, 1}, {270, 31, 3}};
          const auto part = filled<float>(noise, grid, box);
          for (int z = 0; z < box.size.z; ++z)
            for (int y = 0; y < box.size.y; ++y)
              ASSERT_EQ(std::memcmp(&part[static_cast<std::size_t>(z * box.size.y + y) * box.size.x],
                                    &results[0][static_cast<std::size_t>(
                                        ((z + 1) * grid.size.y + y + 3) * grid.size.x + 17)],
                                    sizeof(float) * box.size.x),
                        0)
                  << cells << " " << smooth << " row " << y;
        }
}

// Clamped to [0, 1], many are 0: halves of nothing were 1/4.
TEST(Fill, OfValuesHasHalvesOfItsFloats) {
  for (const Kind kind : {Kind::kValue, Kind::kPerlin}) {
    NoiseParams p{.kind = kind, .frequency = {9, 7, 5}, .octaves = 2, .amplitude = 8.0};
    p.normalisation = Normalisation::kThesis;
    p.persistence = 0.0;
    p.smooth = false;
    const Noise noise(p);
    const Grid grid = Grid::tile({83, 21, 5});
    const auto floats = filled<float>(noise, grid);
    const auto halves = filled<Half>(noise, grid);
    for (std::size_t i = 0; i < floats.size(); ++i) {
      if (floats[i] == 0.0f) {
        ASSERT_EQ(halves[i].bits, 0);
      }
      if (floats[i] == 1.0f) {
        ASSERT_EQ(halves[i].bits, 0x3c00);
      }
    }
    const auto zeros = std::count(floats.begin(), floats.end(), 0.0f);
    EXPECT_EQ(std::count_if(halves.begin(), halves.end(), [](Half h) { return h.bits == 0; }), zeros);
  }
}

TEST(Fill, IsTheSameForAnyThreadCount) {
  const int before = threadCount();
  for (const Case& c : cases()) {
    const Noise noise(c.params);
    setThreadCount(1);
    const auto one = filled<float>(noise, c.grid);
    setThreadCount(5);
    EXPECT_TRUE(sameBytes(one, filled<float>(noise, c.grid))) << c.name;
  }
  setThreadCount(before);
}

TEST(Fill, GivesABoxWhatTheWholeHasThere) {
  for (const Case& c : cases()) {
    const Noise noise(c.params);
    const auto whole = filled<float>(noise, c.grid);
    const bool solid = c.grid.size.z > 1;
    for (const Box box : {Box{{13, 7, solid ? 5 : 0}, {19, 11, solid ? 6 : 1}},
                          Box{{0, 9, solid ? 2 : 0}, {c.grid.size.x, 1, 1}}, Box{{35, 28, 0}, {1, 1, 1}}}) {
      const auto part = filled<float>(noise, c.grid, box);
      const auto row = static_cast<std::size_t>(box.size.x) * noise.channels();
      for (int z = 0; z < box.size.z; ++z)
        for (int y = 0; y < box.size.y; ++y) {
          const std::size_t from =
              ((static_cast<std::size_t>(box.first.z + z) * c.grid.size.y + box.first.y + y) * c.grid.size.x +
               box.first.x) *
              noise.channels();
          const std::size_t at = (static_cast<std::size_t>(z) * box.size.y + y) * row;
          EXPECT_EQ(std::memcmp(&whole[from], &part[at], row * sizeof(float)), 0) << c.name;
        }
    }
  }
}

// Sums are worked out in strips of chunks of rows, that share lines of lattice points with the chunk before,
// and stored as they are made: a row alone, which shares nothing, is the same, from any sample to any other.
template <class T>
void expectRowsOfTheWhole(const NoiseParams& p) {
  const Noise noise(p);
  const Grid grid{{333, 139, 2}, glm::dvec3(1.0)};
  const auto whole = filled<T>(noise, grid);
  for (int y = 0; y < grid.size.y; ++y) {
    const Box box{{7 * y % 150, y, y % 2}, {11 + 5 * y % 170, 1, 1}};
    const auto row = filled<T>(noise, grid, box);
    const T* there =
        &whole[(static_cast<std::size_t>(box.first.z) * grid.size.y + y) * grid.size.x + box.first.x];
    EXPECT_EQ(std::memcmp(row.data(), there, row.size() * sizeof(T)), 0) << p.frequency.y << " row " << y;
  }
}
TEST(Fill, GivesEveryRowOfManyChunksWhatItHasAlone) {
  for (const double cells : {1e-4, 0.02, 0.25, 0.37, 0.93, 0.999, 1.0, 1.7})
    for (const int octaves : {1, 2, 9}) {  // nine: shorter strips
      NoiseParams p{.tile = false, .frequency = {0.9 * cells, cells, 0.3}, .octaves = octaves};
      expectRowsOfTheWhole<float>(p);
      expectRowsOfTheWhole<std::uint8_t>(p);
      p.fractal = Fractal::kBillow;
      expectRowsOfTheWhole<std::uint16_t>(p);
    }
}

// Buffers larger than the caches are written past them, where rows begin at whole vectors.
TEST(Fill, IsTheSameInBuffersLargerThanCaches) {
  constexpr int kSlices = 56;
  for (const Kind kind : {Kind::kPerlin, Kind::kCellular})
    for (const int width : {304, 301}) {
      const Noise noise({.kind = kind, .tile = false, .frequency = {0.04, 0.05, 0.06}, .octaves = 2});
      const Grid grid{{width, 256, kSlices}, glm::dvec3(1.0)};
      const std::size_t slice = static_cast<std::size_t>(width) * 256;
      std::vector<float> large(slice * kSlices + 1);
      ASSERT_GT(slice * kSlices * sizeof(float), kAllBytes);
      for (const std::size_t shift : {0, 1}) {  // by a float
        noise.fill(grid, std::span(large).subspan(shift, slice * kSlices));
        for (int z = 0; z < kSlices; ++z) {
          const auto small = filled<float>(noise, grid, {{0, 0, z}, {width, 256, 1}});
          EXPECT_EQ(std::memcmp(small.data(), &large[shift + slice * z], slice * sizeof(float)), 0)
              << width << " " << z;
        }
      }
    }
}

// One octave of cells is written straight to the caller's floats where whole tiles are wanted, and by way of
// blocks of the fill's own where not: the same values, clamped alike.
TEST(Fill, OfCellsIsTheSameInWholeTilesAndParts) {
  for (const int dimensions : {2, 3})
    for (const Feature feature : {Feature::kF1, Feature::kF2, Feature::kF2MinusF1})
      for (const Normalisation n : {Normalisation::kRaw, Normalisation::kThesis, Normalisation::kUnitRange,
                                    Normalisation::kUnitVariance})
        for (const double cells : {2.0, 9.0, 20.0}) {  // tiles in half a cell, cut into cubes, dense
          const Noise noise({.kind = Kind::kCellular,
                             .dimensions = dimensions,
                             .frequency = glm::dvec3(cells),
                             .octaves = 1,
                             .amplitude = 1.4,  // above what is clamped
                             .feature = feature,
                             .normalisation = n});
          const Grid grid = Grid::tile({72, 40, dimensions == 3 ? 40 : 1});
          const auto whole = filled<float>(noise, grid);
          for (int z = 0; z < grid.size.z; z += 7)
            for (int y = 1; y < grid.size.y; y += 5) {
              const auto row = filled<float>(noise, grid, {{3, y, z}, {66, 1, 1}});
              const std::size_t from = (static_cast<std::size_t>(z) * grid.size.y + y) * grid.size.x + 3;
              EXPECT_EQ(std::memcmp(&whole[from], row.data(), row.size() * sizeof(float)), 0)
                  << dimensions << " " << cells << " " << y << " " << z;
            }
        }
}

// Integers and halves are what the floats round to.
TEST(Fill, RoundsToEveryFormat) {
  for (const Normalisation n :
       {Normalisation::kRaw, Normalisation::kThesis, Normalisation::kUnitRange, Normalisation::kUnitVariance})
    for (const Kind kind : {Kind::kPerlin, Kind::kCurl, Kind::kCellular, Kind::kPerlinWorley}) {
      if (kind == Kind::kPerlinWorley && n != Normalisation::kRaw) continue;  // it is in [0, 1] already
      NoiseParams p{.kind = kind, .octaves = 3, .amplitude = 0.7, .normalisation = n};
      const Noise noise(p);
      const Grid grid = Grid::tile({37, 11, 5});
      const auto floats = filled<float>(noise, grid);
      const auto bytes = filled<std::uint8_t>(noise, grid);
      const auto words = filled<std::uint16_t>(noise, grid);
      const auto halves = filled<Half>(noise, grid);
      for (std::size_t i = 0; i < floats.size(); ++i) {
        const double v = floats[i];
        const bool isSigned =
            n == Normalisation::kRaw && kind != Kind::kCellular && kind != Kind::kPerlinWorley;
        const Lift lift = liftOf(p);
        const double u = n == Normalisation::kUnitVariance ? 0.5 + v / 8
                         : isSigned && kind == Kind::kCurl ? lift.scale * v + lift.bias
                         : isSigned                        ? (v + 1) / 2
                                                           : v;
        const double clamped = std::min(std::max(u, 0.0), 1.0);
        EXPECT_NEAR(bytes[i], 255 * clamped, 0.5001);
        EXPECT_NEAR(words[i], 65535 * clamped, 0.51);
        // A half's value from its bits; within half of its last bit.
        const int exponent = halves[i].bits >> 10 & 31;
        const double fraction = (halves[i].bits & 1023) / 1024.0;
        const double magnitude =
            exponent == 0 ? std::ldexp(fraction, -14) : std::ldexp(1.0 + fraction, exponent - 15);
        const double half = (halves[i].bits & 0x8000) != 0 ? -magnitude : magnitude;
        EXPECT_LE(std::abs(half - v), std::ldexp(1.0, std::max(exponent, 1) - 15 - 11));
      }
    }
}

// Many cells between samples: the memory for them does not grow as their number, and boxes agree.
TEST(Fill, OfCellsSmallerThanSamplesTakesLittleMemory) {
  for (const Kind kind : {Kind::kCellular, Kind::kPerlinWorley})
    for (const int dimensions : {2, 3})
      for (const double step : {3.3, 7.7, 500.0, 1e8}) {
        NoiseParams p{.kind = kind, .dimensions = dimensions, .tile = false, .octaves = 1};
        p.frequency = glm::dvec3(0.125, 1.0, 1.0);
        p.frequency *= kind == Kind::kPerlinWorley ? 0.125 : 1.0;  // its finest octave
        const Noise noise(p);
        const Grid grid{{40, 20, dimensions == 3 ? 10 : 1}, glm::dvec3(step)};
        const Box box{{3, 9, dimensions == 3 ? 1 : 0}, {30, 11, dimensions == 3 ? 9 : 1}};
        const auto channels = static_cast<std::size_t>(noise.channels());
        std::vector<float> whole(channels * 40 * 20 * grid.size.z), part(channels * 30 * 11 * box.size.z);
        gMost = std::size_t{32} << 20;
        noise.fill(grid, std::span(whole));
        noise.fill(grid, box, std::span(part));
        gMost = std::numeric_limits<std::size_t>::max();
        std::size_t at = 0;
        for (int z = 0; z < box.size.z; ++z)
          for (int y = 0; y < box.size.y; ++y)
            for (std::size_t x = 0; x < channels * 30; ++x, ++at) {
              const glm::ivec3 of = box.first + glm::ivec3(0, y, z);
              ASSERT_EQ(part[at], whole[channels * ((of.z * 20 + of.y) * 40 + 3) + x])
                  << "kind " << static_cast<int>(kind) << " dimensions " << dimensions << " step " << step;
            }
        for (int x = 0; x < 40; ++x)
          for (std::size_t c = 0; c < channels; ++c)
            EXPECT_NEAR(whole[channels * x + c],
                        noise.sample(step * glm::dvec3(x + 0.5, 0.5, 0.5), static_cast<int>(c)), 4e-6)
                << "kind " << static_cast<int>(kind) << " dimensions " << dimensions << " step " << step;
      }
}

// Memory that is lent again after some was refused is what it says it is.
TEST(Fill, ScratchSurvivesRefusedMemory) {
  constexpr std::size_t kBytes = 100000;
  Scratch scratch;
  const auto use = [&] {
    std::memset(scratch.take<std::byte>(kBytes), 1, kBytes);
    std::memset(scratch.take<std::byte>(3 * kBytes), 2, 3 * kBytes);
  };
  const auto refuse = [&](std::size_t most, const auto& what) {
    gMost = most;
    EXPECT_THROW(what(), std::bad_alloc);
    gMost = std::numeric_limits<std::size_t>::max();
  };
  std::memset(scratch.take<std::byte>(kBytes), 0, kBytes);
  refuse(kBytes, [&] { scratch.take<std::byte>(50 * kBytes); });
  const long before = gAllocations;
  scratch.take<std::byte>(2 * kBytes);
  const long after = gAllocations;
  EXPECT_GT(after, before) << "the block before has no room";
  refuse(2 * kBytes, [&] { scratch.reset(); });  // the blocks become one
  use();
  gMost = 5 * kBytes;
  EXPECT_NO_THROW(scratch.reset());
  gMost = std::numeric_limits<std::size_t>::max();
  use();
}

TEST(Fill, AgainAllocatesNothing) {
  const int before = threadCount();
  for (const int threads : {1, 2}) {
    setThreadCount(threads);
    for (const Case& c : cases()) {
      const Noise noise(c.params);
      std::vector<float> out(static_cast<std::size_t>(c.grid.size.x) * c.grid.size.y * c.grid.size.z *
                             noise.channels());
      for (int i = 0; i < 2; ++i) noise.fill(c.grid, std::span(out));
      // Scratch memory is made for as many threads as were ever at work at once, which chance decides.
      long least = std::numeric_limits<long>::max();
      for (int i = 0; i < (threads == 1 ? 1 : 10) && least > 0; ++i) {
        const long counted = gAllocations;
        noise.fill(c.grid, std::span(out));
        least = std::min(least, gAllocations - counted);
      }
      EXPECT_EQ(least, 0) << c.name << ", threads " << threads;
    }
  }
  setThreadCount(before);
}

}  // namespace
}  // namespace welkin::noise
