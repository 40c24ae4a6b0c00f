// SPDX-License-Identifier: Apache-2.0
// Metaballs drawn into a grid of voxels, vectorised: what rasterising and fitting are made of.
//
// Rows are `stride` floats apart, at least nx + kRowPadding: vectors may run over the end of a row into its
// padding, where they read anything finite and add zeros, and never into the next row.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>

namespace welkin::field {

constexpr int kRowPadding = 16;

// Voxel (i, j, k) is the point first + (i, j, k) * step, any unit; x runs fastest, then y, then z.
struct BallGrid {
  int nx = 0, ny = 0, nz = 0;
  int stride = 0;
  glm::dvec3 first{0.0}, step{1.0};

  std::size_t row(int y, int z) const { return (static_cast<std::size_t>(z) * ny + y) * stride; }
  std::size_t floats() const { return static_cast<std::size_t>(stride) * ny * nz; }
};

struct GridBall {
  glm::dvec3 centre{0.0};
  double radius = 1.0;  // > 0
  double weight = 0.0;
};

struct VoxelRange {
  int begin = 0, end = 0;  // [begin, end)
};
using SliceRange = VoxelRange;

// Those of `count` voxels, i * step, that are within `reach` of `middle`.
inline VoxelRange voxelsWithin(double middle, double reach, double step, int count) {
  const double most = count;
  const double from = std::clamp(std::ceil((middle - reach) / step), 0.0, most);
  const double to = std::clamp(std::floor((middle + reach) / step) + 1.0, 0.0, most);
  return {static_cast<int>(from), static_cast<int>(to)};
}

inline SliceRange slicesOf(const BallGrid& grid, const GridBall& ball) {
  return voxelsWithin(ball.centre.z - grid.first.z, ball.radius, grid.step.z, grid.nz);
}

// Adds factor * f(|x - centre| / radius), f Wyvill's function, to the voxels of those slices.
void addBall(const BallGrid& grid, const GridBall& ball, double factor, SliceRange slices, float* voxels);

}  // namespace welkin::field
