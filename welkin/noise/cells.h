// SPDX-License-Identifier: Apache-2.0
// Cellular noise at a point: S. Worley 1996, "A Cellular Texture Basis Function". One feature point in every
// cell of a lattice, anywhere in it. The reference for the grid fills.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "welkin/noise/lattice.h"

namespace welkin::noise {

// Place of a cell's feature point within it, [0, 1) on each axis, uniform: from the cell's hash (the sum of
// its axes' hashes). In time each coordinate moves at its own pace and is reflected by the cell's walls, so
// that it stays uniform at every instant.
struct FeaturePlace {
  std::array<float, 3> inside;
};

struct Distances {
  double f1, f2;  // to the nearest feature point and to the second, in cells
};

class CellLattice {
 public:
  // 2 or 3 axes. Time in cells; with a period (whole, > 0) the points are back after it.
  CellLattice(int axes, const std::array<Axis, 3>& axis, std::optional<double> time, double timePeriod);

  // At a position in units of the domain; exact, however far the second point is. f1 <= f2 <= sqrt(3).
  Distances at(const std::array<double, 3>& position) const;

  FeaturePlace place(std::uint32_t cellHash) const;

  // A point's place on axis a is kUnit times the upper 24 bits of mix32(cellHash + (a + 1) * kAxisStep).
  static constexpr std::uint32_t kAxisStep = 0x9e3779b9u;
  static constexpr float kUnit = 1.0f / 16777216.0f;
  bool moves() const { return time_.has_value(); }

  int axes() const { return axes_; }
  const Axis& axis(int i) const { return axis_[static_cast<std::size_t>(i)]; }

 private:
  int axes_;
  std::array<Axis, 3> axis_;
  std::optional<double> time_;
  double timePeriod_;
};

}  // namespace welkin::noise
