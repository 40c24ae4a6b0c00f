// SPDX-License-Identifier: Apache-2.0
// Gradient noise of two, three and four axes at a point: the reference for the grid fills.
// Improved noise: K. Perlin 2002, "Improving Noise".
#pragma once

#include <array>
#include <cstdint>

#include "welkin/noise/lattice.h"

namespace welkin::noise {

// The directions a lattice point chooses from by its hash. Their components are exact in the upper 8 (three
// and four axes) or 16 bits (two axes) of a float, so that vectors of them come from byte look-ups.
//   two axes: eight directions, 22.5 + k 45 degrees (to 0.1 degree), length sqrt(2)
//   three: Perlin's twelve edges of the cube, four of them twice
//   four: sixteen of the 32 edges (0, +-1, +-1, +-1) in any order: tetrahedra, two pointing each way, so that
//     their sum is zero and their covariance a multiple of the identity
std::array<float, 4> gradientOf(int axes, std::uint32_t hash);

// The same for look-ups of bytes: byte h is the upper byte of component [axis] of gradient h, with two axes
// byte 8 + h the second; as floats. Times kGradientBytesScale.
struct GradientBytes {
  alignas(16) std::uint8_t component[4][16];
};
const GradientBytes& gradientBytes(int axes);
constexpr float gradientBytesScale(int axes) {
  return axes == 2 ? 1.0f : 2.0f;
}

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
