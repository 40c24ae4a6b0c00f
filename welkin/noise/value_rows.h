// SPDX-License-Identifier: Apache-2.0
// What value noise does for one lattice point, and for rows of them on the processor's best instruction set.
// Nothing is fused, so that every set gives the same bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "welkin/core/random.h"

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

// The project's own in [-1, 1), hashOf(seed, x, y, z), from the hash of x and what a row of points shares.
struct OwnRow {
  std::uint64_t hashedSeed, hashedRest;
};
constexpr OwnRow ownRow(std::uint64_t seed, std::uint32_t y, std::uint32_t z) {
  return {hashOf(seed), hashOf(y, z)};
}
constexpr float ownHash(std::uint64_t hashedX, const OwnRow& of) {
  return 2.0f * unitFloat(joinHashes(of.hashedSeed, joinHashes(hashedX, of.hashedRest))) - 1.0f;
}

// The 27-point average from bare values: edges and corners weigh the same, so the sum over the cube does most
// of it. Sums of 27 bare values are exact in doubles, in any order.
inline constexpr double kCentre = 9.0 / 18.0, kFace = 4.0 / (18.0 * 6.0), kRest = 3.0 / (18.0 * 12.0);
static_assert(kRest == 2.0 / (18.0 * 8.0));
constexpr float smoothedValue(double cube, double faces, double centre) {
  return static_cast<float>(kRest * (cube - faces - centre) + kFace * faces + kCentre * centre);
}

// Hashes of `count` points of a row.
void sourceHashes(const std::uint32_t* x, int count, std::uint32_t row, float* out);
void ownHashes(const std::uint64_t* hashedX, int count, const OwnRow& row, float* out);

// The sums over 3 x 3 points around each of a row but the first and the last; rows lie `width` apart.
void sumBoxes(const float* row, int width, double* out);
// Averages over 27 points for a row but its first and last: of the planes below, here and above, the values
// and what sumBoxes() made of them.
template <class T>
using Three = std::array<const T*, 3>;
void smoothRow(const Three<float>& values, const Three<double>& boxes, int width, float* out);

// out = the sum of rows times weights. One to four taps.
struct Tap {
  const float* row;
  float weight;
};
void mixRows(std::span<const Tap> taps, int count, float* out);

}  // namespace welkin::noise
