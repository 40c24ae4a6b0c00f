// SPDX-License-Identifier: Apache-2.0
// What a noise is, described once.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "welkin/core/params.h"
#include "welkin/noise/value.h"

namespace welkin::noise {

enum class Kind {
  kPerlin,        // improved gradient noise: K. Perlin 2002, "Improving Noise"
  kValue,         // hashed and smoothed value noise (noise/value.h)
  kCellular,      // distances to scattered points: S. Worley 1996, "A Cellular Texture Basis Function"
  kPerlinWorley,  // gradient noise dilated by cells, and three sums of cells: A. Schneider 2015, "The
                  // Real-time Volumetric Cloudscapes of Horizon: Zero Dawn". Four channels
  kCurl,          // divergence-free vectors: R. Bridson, J. Hourihan, M. Nordenstam 2007, "Curl-Noise for
                  // Procedural Fluid Flow". As many channels as dimensions
  kDistorted,     // gradient noise looked up at places that other gradient noise has shifted
};

// How octaves are summed. n is the noise of one octave, in [-1, 1].
enum class Fractal {
  kFbm,     // n
  kBillow,  // 2 |n| - 1: round bumps, creases between them
  kRidged,  // 2 (1 - |n|)^2 - 1: sharp crests
};

enum class Feature { kF1, kF2, kF2MinusF1 };  // distance to the nearest point, the second, their difference

// Where the hash of the lattice comes from.
enum class Table {
  kSeeded,     // from the seed; each octave has its own, and none repeats within 2^32 cells
  kPublished,  // Perlin's permutation: his values exactly, repeats every 256 cells; or the hash of value
               // noise as its source has it, the same for every octave (noise/value.h). Time is their third
               // axis, in a plane
};

// What becomes of the sum v = sum_o amplitude persistence^o n_o.
enum class Normalisation {
  kRaw,     // v
  kThesis,  // clamp(sum_o a_o (n_o + 1) / 2, 0, 1), every octave lifted to be positive; cells: clamp(v, 0, 1)
  kUnitRange,     // linear, so that the values the noise can take fill [0, 1]; never outside
  kUnitVariance,  // linear, to mean 0 and deviation 1 over the infinite lattice (not over one tile). With a
                  // time: over all times; a single one of them has up to 0.13 less or more
};

struct NoiseParams {
  Kind kind = Kind::kPerlin;
  std::int64_t dimensions = 3;
  bool tile = true;
  glm::dvec3 frequency{4.0, 4.0, 4.0};
  std::int64_t octaves = 4;
  double lacunarity = 2.0;
  double amplitude = 1.0;
  double persistence = 0.5;
  Fractal fractal = Fractal::kFbm;
  Feature feature = Feature::kF1;
  double distortion = 0.5;
  Interpolation interpolation = Interpolation::kCosine;
  bool smooth = true;
  Normalisation normalisation = Normalisation::kRaw;
  std::int64_t seed = 0;
  Table table = Table::kSeeded;
  glm::dvec3 offset{0.0};
  std::optional<double> time = std::nullopt;
  double timePeriod = 0.0;
  double timeLacunarity = 2.0;
};
void describe(NoiseParams& p, ParamVisitor& v);

// Throws ParameterError in a sentence for what does not fit together or is out of its range.
void validate(const NoiseParams& p);

// Noise of these parameters to [0, 1], as integers hold it: v for what is positive by itself or by its
// normalisation, (v + 1) / 2 for raw noise of both signs, 1/2 + v/8 for unit variance. Raw curl, which is a
// derivative and has no bound that is of use: 1/2 + v/(8 s), s the deviation of the channel that has the
// greatest. For parameters that validate() takes.
struct Lift {
  float scale, bias;
};
Lift liftOf(const NoiseParams& p);

}  // namespace welkin::noise

namespace welkin {
using namespace std::string_view_literals;
template <>
inline constexpr std::array kEnumNames<noise::Kind> = {"perlin"sv,        "value"sv, "cellular"sv,
                                                       "perlin-worley"sv, "curl"sv,  "distorted"sv};
template <>
inline constexpr std::array kEnumNames<noise::Fractal> = {"fbm"sv, "billow"sv, "ridged"sv};
template <>
inline constexpr std::array kEnumNames<noise::Feature> = {"f1"sv, "f2"sv, "f2-f1"sv};
template <>
inline constexpr std::array kEnumNames<noise::Table> = {"seeded"sv, "published"sv};
template <>
inline constexpr std::array kEnumNames<noise::Normalisation> = {"raw"sv, "thesis"sv, "unit-range"sv,
                                                                "unit-variance"sv};
}  // namespace welkin
