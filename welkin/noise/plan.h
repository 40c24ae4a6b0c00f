// SPDX-License-Identifier: Apache-2.0
// What parameters come to: the lattices of every octave and their weights. Private to noise/.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "welkin/noise/cells.h"
#include "welkin/noise/gradient.h"
#include "welkin/noise/params.h"
#include "welkin/noise/value.h"

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
  std::vector<GradientTerm> fields;  // one for each dimension, weight 1
  double weight;
};

struct ValueTerm {
  Value noise;
  std::array<Axis, 3> axes;  // in a plane two
  double weight;
  CellPlace beyond = {};  // of a plane along z: a lattice point, or the time of the published table
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
  std::vector<ValueTerm> values;
  std::vector<CellTerm> cells;  // Perlin-Worley: its four, the weights unused
  Affine normalise;             // of raw sums
  Affine quantise;              // of normalised values, to [0, 1], for integer formats
};

Plan makePlan(const NoiseParams& params);

// Frequencies of the fields that distort along x, y and z, of the noise's.
inline constexpr std::array<double, 3> kDistortionStretch = {1.0, 3.33, 7.77};

// What a sum takes of one octave.
inline double shaped(Fractal fractal, double n) {
  switch (fractal) {
    case Fractal::kFbm:
      return n;
    case Fractal::kBillow:
      return 2.0 * std::abs(n) - 1.0;
    case Fractal::kRidged:
      break;
  }
  const double rest = 1.0 - std::abs(n);
  return 2.0 * rest * rest - 1.0;
}

// Perlin-Worley's sums of 1 - F1 at three frequencies, each twice the one before; the finest has two.
inline constexpr float kCoarse[3] = {0.625f, 0.25f, 0.125f}, kFine[2] = {0.75f, 0.25f};

// Its channels, from gradient noise and four frequencies of cells, all in [0, 1].
constexpr std::array<double, 4> perlinWorley(double gradient, const std::array<double, 4>& w) {
  const double coarse = kCoarse[0] * w[0] + kCoarse[1] * w[1] + kCoarse[2] * w[2];
  const double middle = kCoarse[0] * w[1] + kCoarse[1] * w[2] + kCoarse[2] * w[3];
  const double fine = kFine[0] * w[2] + kFine[1] * w[3];
  return {middle + gradient * (1.0 - middle), coarse, middle, fine};
}

}  // namespace welkin::noise
