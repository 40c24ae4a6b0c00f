// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/density_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"

namespace welkin::fit {
namespace {

void count(DensityGrid& g) {
  g.squares = 0.0;
  g.cloudVoxels = 0;
  for (int z = 0; z < g.grid.nz; ++z)
    for (int y = 0; y < g.grid.ny; ++y) {
      double row = 0.0;
      const float* at = &g.density[g.grid.row(y, z)];
      for (int x = 0; x < g.grid.nx; ++x) {
        row += static_cast<double>(at[x]) * static_cast<double>(at[x]);
        g.cloudVoxels += at[x] != 0.0f;
      }
      g.squares += row;
    }
}

}  // namespace

DensityGrid densityGrid(const Volume<float>& map, const field::VoxelFrame& frame) {
  if (map.data.empty()) throw ParameterError("the map has no voxels");
  DensityGrid g;
  g.grid = {map.nx, map.ny, map.nz, map.nx + field::kRowPadding, frame.firstVoxelM, frame.voxelSizeM};
  g.density.assign(g.grid.floats(), 0.0f);
  for (int z = 0; z < map.nz; ++z)
    for (int y = 0; y < map.ny; ++y) {
      const float* row = &map.at(0, y, z);
      for (int x = 0; x < map.nx; ++x)
        if (!std::isfinite(row[x]))
          throw ParameterError("the map's density at voxel (" + std::to_string(x) + ", " + std::to_string(y) +
                               ", " + std::to_string(z) + ") is not finite");
      std::copy_n(row, map.nx, &g.density[g.grid.row(y, z)]);
    }
  count(g);
  if (!(g.squares > 0.0)) throw ParameterError("the map is empty: its density is 0 everywhere");
  if (!std::isfinite(g.squares)) throw ParameterError("the map's densities are too large to be squared");
  return g;
}

DensityGrid coarser(const DensityGrid& fine) {
  const BallGrid& from = fine.grid;
  const auto half = [](int n) { return n == 1 ? 1 : (n + 1) / 2; };
  DensityGrid g;
  BallGrid& to = g.grid;
  to.nx = half(from.nx), to.ny = half(from.ny), to.nz = half(from.nz);
  to.stride = to.nx + field::kRowPadding;
  const glm::dvec3 factor(from.nx > 1 ? 2 : 1, from.ny > 1 ? 2 : 1, from.nz > 1 ? 2 : 1);
  to.step = from.step * factor;
  to.first = from.first + 0.5 * (factor - 1.0) * from.step;
  g.density.assign(to.floats(), 0.0f);
  parallelFor(static_cast<std::size_t>(to.nz), 4, [&](std::size_t begin, std::size_t end) {
    for (auto z = static_cast<int>(begin); z < static_cast<int>(end); ++z)
      for (int y = 0; y < to.ny; ++y)
        for (int x = 0; x < to.nx; ++x) {
          double sum = 0.0;
          for (int k = 0; k < 8; ++k) {
            const int i = x * static_cast<int>(factor.x) + (k & 1),
                      j = y * static_cast<int>(factor.y) + (k >> 1 & 1),
                      l = z * static_cast<int>(factor.z) + (k >> 2);
            const bool there = i < from.nx && j < from.ny && l < from.nz &&
                               (factor.x > 1.0 || (k & 1) == 0) && (factor.y > 1.0 || (k >> 1 & 1) == 0) &&
                               (factor.z > 1.0 || k >> 2 == 0);
            if (there) sum += static_cast<double>(fine.density[from.row(j, l) + static_cast<std::size_t>(i)]);
          }
          // What lies beyond the far face counts as clear air.
          const double voxels = factor.x * factor.y * factor.z;
          g.density[to.row(y, z) + static_cast<std::size_t>(x)] = static_cast<float>(sum / voxels);
        }
  });
  count(g);
  return g;
}

}  // namespace welkin::fit
