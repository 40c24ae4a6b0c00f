// SPDX-License-Identifier: Apache-2.0
// The lattice under every noise here: where on it a position lies, and the hash of its points. The same on
// every machine; shared by the point functions and the grid fills.
#pragma once

#include <cstdint>

namespace welkin::noise {

// Finaliser of MurmurHash3 (A. Appleby 2011): a bijection of 32 bits with full avalanche.
constexpr std::uint32_t mix32(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  return h ^ (h >> 16);
}

// The hash of a lattice point is built of one hash for each axis, so that a row of points shares all but the
// first and costs a multiplication a point:
//   pointHash = (hash_x | 1) * rowHash(hash_y + hash_z + hash_t)
// Bits kGradientShift and up select a gradient: they depend on all lower bits of both factors.
inline constexpr int kGradientShift = 24;
constexpr std::uint32_t rowHash(std::uint32_t sum) {
  return mix32(sum) | 1u;
}
constexpr std::uint32_t pointHash(std::uint32_t hashX, std::uint32_t row) {
  return (hashX | 1u) * row;
}

inline constexpr std::uint32_t kHashStep = 0x9e3779b9u;
constexpr std::uint32_t axisHash(std::uint32_t key, std::uint32_t index) {
  return mix32(index * kHashStep + key);
}

// A place between two lattice points of an axis.
struct Span {
  std::uint32_t low, high;  // indices of the points below and above, wrapped
  double inside;            // distance from the lower one, in [0, 1)
};

// One axis of one octave's lattice.
class Axis {
 public:
  Axis() = default;
  // `frequency` cells a unit of the domain; positions are shifted by `offset` units. With repeat > 0 the
  // lattice repeats after so many units; repeat * frequency must then be whole, and at least 1. Few cells
  // more are added after all that, where a far offset does not round them.
  Axis(std::uint32_t key, double frequency, double offset, double repeat, double cells = 0.0);

  // Exact to the last bits of a double however far the position is: neither the sum nor the product loses
  // the place within the cell. p must be finite; the shift is added in cells. Where the product overflows the
  // place is that of 0.
  Span at(double p, double shiftCells = 0.0) const;

  std::uint32_t hash(std::uint32_t index) const { return axisHash(key_, index); }
  double frequency() const { return frequency_; }
  std::uint32_t key() const { return key_; }
  std::uint32_t period() const { return period_; }  // cells; 0: 2^32
  // The index `steps` cells from `index`, wrapped.
  std::uint32_t moved(std::uint32_t index, std::int64_t steps) const;

 private:
  std::uint32_t key_ = 0;
  std::uint32_t period_ = 0;  // cells; 0: 2^32
  double frequency_ = 1.0, offset_ = 0.0, repeat_ = 0.0, cells_ = 0.0;
};

// Perlin's fade 6 t^5 - 15 t^4 + 10 t^3 and its derivative.
template <class T>
constexpr T fade(T t) {
  return t * t * t * (t * (t * T(6) - T(15)) + T(10));
}
template <class T>
constexpr T fadeSlope(T t) {
  return T(30) * t * t * (t * (t - T(2)) + T(1));
}

}  // namespace welkin::noise
