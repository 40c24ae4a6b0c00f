// SPDX-License-Identifier: Apache-2.0
// All balls over the grid: residuals and products with the Jacobian, without ever storing it. Private to
// fit/.
//
// Threads change nothing: voxels belong to slabs, in which balls are added in their order, and sums over
// voxels belong to a ball.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "welkin/fit/density_grid.h"

namespace welkin::fit {

// Which balls touch which slab of the grid.
class BallLists {
 public:
  BallLists(const BallGrid& grid, std::span<const GridBall> balls);

  struct Entry {
    std::uint32_t ball;
    SliceRange slices;  // within the slab
  };
  int slabs() const { return static_cast<int>(lists_.size()); }
  SliceRange slab(int s) const;
  std::span<const Entry> entries(int s) const { return lists_[static_cast<std::size_t>(s)]; }
  // Whether the work is worth threads.
  bool many() const { return many_; }

 private:
  int nz_;
  bool many_ = false;
  std::vector<std::vector<Entry>> lists_;
};

// r = sum of the balls less the map; returns |r|^2.
double residual(const DensityGrid& data, std::span<const GridBall> balls, const BallLists& lists,
                std::vector<float>& r);

// The balls at which the Jacobian J is taken, five columns a ball: weight, centre, ln radius.
class Jacobian {
 public:
  // Keeps references to both.
  Jacobian(const DensityGrid& data, std::span<const GridBall> balls);

  std::size_t columns() const { return 5 * balls_.size(); }
  void times(std::span<const double> p, std::vector<float>& out) const;            // J p
  void transposedTimes(const std::vector<float>& r, std::span<double> out) const;  // J^T r
  std::vector<BallBlock> blocks() const;  // of J^T J, on its diagonal

 private:
  const DensityGrid& data_;
  std::span<const GridBall> balls_;
  BallLists lists_;
};

// A ball's term alone on the part of a grid that it touches.
struct BallPatch {
  BallGrid grid;
  std::vector<float> voxels;
};
BallPatch patchOf(const BallGrid& grid, const GridBall& ball, double factor);

// Pairs that overlap: for each ball those whose surfaces it meets, in their order.
std::vector<std::vector<std::uint32_t>> neighboursOf(std::span<const GridBall> balls);

}  // namespace welkin::fit
