// SPDX-License-Identifier: Apache-2.0
// What parameters come to: the lattices of every octave and their weights. Private to noise/.
#pragma once

#include <array>
#include <vector>

#include "welkin/noise/cells.h"
#include "welkin/noise/gradient.h"
#include "welkin/noise/params.h"

namespace welkin::noise {

// weight * n, or weight times the derivative of n by a cell of one axis.
struct GradientTerm {
  GradientLattice lattice;
  double weight;
  int derivative = -1;  // axis; -1: the noise itself
};

// An octave of distorted noise: `main` looked up at places shifted by `distortion` times the fields.
struct DistortedTerm {
  GradientLattice main;
  std::vector<GradientLattice> fields;  // one for each dimension
  double weight;
};

struct CellTerm {
  CellLattice lattice;
  double weight;
};

// clamp(scale * raw + bias, low, high)
struct Affine {
  double scale = 1.0, bias = 0.0;
  double low, high;
};

struct Plan {
  std::vector<std::vector<GradientTerm>> gradients;  // for each channel a sum; Perlin-Worley: one sum
  std::vector<DistortedTerm> distorted;
  std::vector<CellTerm> cells;  // Perlin-Worley: its four, the weights unused
  Affine normalise;             // of raw sums
  Affine quantise;              // of normalised values, to [0, 1], for integer formats
};

Plan makePlan(const NoiseParams& params);

// Perlin-Worley's three sums of 1 - F1 at four frequencies, each twice the one before, and the part of
// gradient noise. `cells` are clamped to [0, 1], `gradient` lies in [0, 1].
template <class T>
constexpr std::array<T, 4> perlinWorley(T gradient, const std::array<T, 4>& cells) {
  const T coarse = T(0.625) * cells[0] + T(0.25) * cells[1] + T(0.125) * cells[2];
  const T middle = T(0.625) * cells[1] + T(0.25) * cells[2] + T(0.125) * cells[3];
  const T fine = T(0.75) * cells[2] + T(0.25) * cells[3];
  return {middle + gradient * (T(1) - middle), coarse, middle, fine};
}

}  // namespace welkin::noise
