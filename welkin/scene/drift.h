// SPDX-License-Identifier: Apache-2.0
// Weather that wanders by itself: slow noise turns the wind and changes the cover over hours (K. Pallister,
// "Generating Procedural Clouds Using 3D Hardware", wishes for it). A pure function of time: any instant
// directly, forwards and backwards. At the scene's time, and on average, the weather is as described.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "welkin/core/params.h"
#include "welkin/field/condensation.h"
#include "welkin/field/pattern_quantiles.h"

namespace welkin::scene {

struct Drift {
  double windDeg = 0.0;     // the most by which the wind turns to either side
  double coverOktas = 0.0;  // the most by which a sheet's cover rises and falls, within 0 to 8
  double periodH = 3.0;     // one swing to and fro, about

  bool operator==(const Drift&) const = default;
};
void describe(Drift& d, ParamVisitor& v);

// Noise of mean 0 in [-1, 1], twice continuously differentiable, 0 at 0, one swing for each unit of x on
// average; it returns after kDriftLoop. Two octaves of K. Perlin's gradient noise (2002, "Improving Noise").
double driftNoise(std::uint64_t seed, double x);
inline constexpr int kDriftLoop = 64;

// Where air goes in `seconds`, in a wind of 1 m/s from this direction on average: the integral of its
// velocity, east and north, metres. By Gauss and Legendre on a fixed partition, over one loop of the noise at
// most: its cost is bounded, and its error below a metre in a loop of hours.
glm::dvec2 windPath(const Drift& d, std::uint64_t seed, double windFromDeg, double seconds);

// The wind's direction at that instant; not wrapped.
double windFromDegAt(const Drift& d, std::uint64_t seed, double windFromDeg, double seconds);

// The cover at that instant.
double oktasAt(const Drift& d, std::uint64_t seed, double oktas, double seconds);

// A drift as one sheet has it: all sheets of a scene share the wind's turning, each has its own cover's.
struct SheetDrift {
  Drift drift;
  std::uint64_t windSeed = 0, coverSeed = 0;

  bool operator==(const SheetDrift&) const = default;
};

}  // namespace welkin::scene
