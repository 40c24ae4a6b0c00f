// SPDX-License-Identifier: Apache-2.0
// The hashes and the average of value noise, for one lattice point. Private to noise/.
#pragma once

#include <cstdint>

#include "welkin/core/random.h"
#include "welkin/noise/value_clock.h"

namespace welkin::noise {

// Man's hash of a lattice point (value.h), from x + sourceRow(y, z).
constexpr std::uint32_t sourceRow(std::uint32_t y, std::uint32_t z) {
  return 57u * y + 57u * 57u * z;
}
constexpr float sourceHash(std::uint32_t m) {
  const std::uint32_t n = (m << 13) ^ m;
  const std::uint32_t bits = (n * (n * n * 15731u + 789221u) + 1376312589u) & 0x7fffffffu;
  return static_cast<float>(0x40000000 - static_cast<std::int32_t>(bits)) * 0x1p-30f;
}

// The project's own, hashOf(seed, x, y, z), of what is known of x once for all rows and of a row of points
// once for all x; both with the first step of the hash's mixing done, which the xor of two may follow.
constexpr std::uint64_t ownColumn(std::uint32_t x) {
  return mixStart(hashOf(x));
}
struct OwnRow {
  std::uint64_t first, rest;
};
constexpr OwnRow ownRow(std::uint64_t seed, std::uint32_t y, std::uint32_t z) {
  return {mixStart(hashOf(seed)), mixStart(hashOf(y, z) * kHashFactor)};
}
// In [-1, 1), counted in kOwnStep.
inline constexpr float kOwnStep = 0x1p-23f;
inline constexpr std::int32_t kOwnHalf = 1 << 23;
constexpr std::uint64_t ownPoint(std::uint64_t column, std::uint64_t rest) {  // what is shared by all seeds
  return mixRest(column ^ rest) * kHashFactor;
}
constexpr std::int32_t ownSteps(std::uint64_t first, std::uint64_t point) {
  return static_cast<std::int32_t>(mixRest(first ^ mixStart(point)) >> 40) - kOwnHalf;
}
constexpr std::int32_t ownSteps(std::uint64_t column, const OwnRow& row) {
  return ownSteps(row.first, ownPoint(column, row.rest));
}
constexpr float ownHash(std::uint64_t column, const OwnRow& row) {
  return static_cast<float>(ownSteps(column, row)) * kOwnStep;
}

// With a time: the seed of the noise that a whole time has, and a point's phase, in kTimePhases.
constexpr std::uint64_t timeSeed(std::uint64_t seed, std::uint32_t time) {
  return hashOf(seed, time);
}
constexpr int timePhase(std::uint64_t point) {
  static_assert(kTimePhases == 16);
  return static_cast<int>(point >> 60);
}

// The 27-point average from bare values: edges and corners weigh the same, so the sum over the cube does most
// of it. Sums of 27 bare values are exact in doubles, of the project's own hash also in 32 bits, in any
// order.
inline constexpr double kCentre = 9.0 / 18.0, kFace = 4.0 / (18.0 * 6.0), kRest = 3.0 / (18.0 * 12.0);
static_assert(kRest == 2.0 / (18.0 * 8.0));
constexpr float smoothedValue(double cube, double faces, double centre) {
  return static_cast<float>(kRest * (cube - faces - centre) + kFace * faces + kCentre * centre);
}

}  // namespace welkin::noise
