// SPDX-License-Identifier: Apache-2.0
// Gradient noise of two, three and four axes at a point: the reference for the grid fills.
// Improved noise: K. Perlin 2002, "Improving Noise".
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "welkin/noise/lattice.h"

namespace welkin::noise {

// The directions a lattice point chooses from by its hash. Their components are exact in the upper 8 (three
// and four axes) or 16 bits (two axes) of a float, so that vectors of them come from byte look-ups.
//   two axes: eight directions, 22.5 + k 45 degrees (to 0.1 degree), length sqrt(2)
//   three: Perlin's twelve edges of the cube, four of them twice
//   four: sixteen of the 32 edges (0, +-1, +-1, +-1) in any order: tetrahedra, two pointing each way, so that
//     their sum is zero and their covariance a multiple of the identity
constexpr std::array<float, 4> gradientOf(int axes, std::uint32_t hash) {
  const auto sign = [hash](int bit) { return (hash >> bit & 1u) == 0 ? 1.0f : -1.0f; };
  if (axes == 2) {
    const float across = 1.3046875f, along = 0.54296875f;  // sqrt(2) times cosine and sine of 22.5 degrees
    return (hash & 4) == 0 ? std::array<float, 4>{sign(0) * across, sign(1) * along}
                           : std::array<float, 4>{sign(0) * along, sign(1) * across};
  }
  std::array<float, 4> g{};
  if (axes == 3) {
    const std::uint32_t h = hash & 15;
    const int u = h < 8 ? 0 : 1, v = h < 4 ? 1 : (h == 12 || h == 14 ? 0 : 2);
    g[u] = sign(0);
    g[v] = sign(1);
    return g;
  }
  const int zero = static_cast<int>(hash >> 2 & 3u);
  const float signs[3] = {sign(0), sign(1), sign(0) * sign(1) * (zero < 2 ? 1.0f : -1.0f)};
  for (int i = 0, n = 0; i < 4; ++i)
    if (i != zero) g[i] = signs[n++];
  return g;
}

constexpr float gradientBytesScale(int axes) {
  return axes == 2 ? 1.0f : 2.0f;
}

// The same for look-ups of bytes: byte h is the upper byte of component [axis] of gradient h, with two axes
// byte 8 + h the second; as floats, times gradientBytesScale().
struct GradientBytes {
  alignas(16) std::uint8_t component[4][16];
};
template <int kAxes>
inline constexpr GradientBytes kGradientBytes = [] {
  GradientBytes made{};
  for (std::uint32_t h = 0; h < 16; ++h) {
    const std::array<float, 4> g = gradientOf(kAxes, h & (kAxes == 2 ? 7 : 15));
    for (int i = 0; i < kAxes; ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(g[i] * gradientBytesScale(kAxes));
      made.component[i][h] = static_cast<std::uint8_t>(kAxes == 2 && h >= 8 ? bits >> 16 : bits >> 24);
    }
  }
  return made;
}();

// Perlin's permutation, as published.
extern const std::array<std::uint8_t, 256> kPublishedPermutation;

struct ValueAndGradient {
  double value;
  std::array<double, 4> gradient;  // per lattice cell, each axis
};

// One octave's lattice. Immutable after construction; safe to share between threads.
class GradientLattice {
 public:
  // 2 to 4 axes. With `published`, three axes and Perlin's permutation in place of the hash.
  GradientLattice(int axes, const std::array<Axis, 4>& axis, bool published);

  // At a position in units of the domain; the fourth is time. Standard deviation 0.27; zero on lattice
  // points; |value| <= bound().
  ValueAndGradient at(const std::array<double, 4>& position,
                      const std::array<double, 4>& shiftCells = {}) const;

  int axes() const { return axes_; }
  const Axis& axis(int i) const { return axis_[static_cast<std::size_t>(i)]; }
  bool published() const { return published_; }
  // Of the gradient of the lattice point with these indices.
  std::uint32_t hash(const std::array<std::uint32_t, 4>& index) const;

  // The least upper bound of |noise|.
  static double bound(int axes);
  // Exact standard deviations over the lattice: of the noise, and of its derivative along `axis` per cell.
  static double deviation(int axes);
  static double slopeDeviation(int axes, int axis);

 private:
  int axes_;
  std::array<Axis, 4> axis_;
  bool published_;
};

}  // namespace welkin::noise
