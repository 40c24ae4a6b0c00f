// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/density_grid.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"

namespace welkin::fit {
namespace {

// Balls' densities and radii, a few times these, stay well within what their files may hold.
constexpr double kLeastDensity = 1e-27, kMostDensity = 1e27, kLeastVoxelM = 1e-9, kMostReachM = 1e12;

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

void expectWithin(const std::string& what, double value, double least, double most) {
  if (value >= least && value <= most) return;
  std::ostringstream text;
  text << what << " is " << value << "; expected " << least << " to " << most;
  throw ParameterError(text.str());
}

}  // namespace

DensityGrid densityGrid(const Volume<float>& map, const field::VoxelFrame& frame) {
  if (map.data.empty()) throw ParameterError("the map has no voxels");
  float largest = 0.0f;
  for (int z = 0; z < map.nz; ++z)
    for (int y = 0; y < map.ny; ++y) {
      const float* row = &map.at(0, y, z);
      for (int x = 0; x < map.nx; ++x) {
        if (!std::isfinite(row[x]))
          throw ParameterError("the map's density at voxel (" + std::to_string(x) + ", " + std::to_string(y) +
                               ", " + std::to_string(z) + ") is not finite");
        largest = std::max(largest, std::abs(row[x]));
      }
    }
  if (largest == 0.0f) throw ParameterError("the map is empty: its density is 0 everywhere");
  expectWithin("the largest density of the map", static_cast<double>(largest), kLeastDensity, kMostDensity);
  const glm::dvec3 voxels(map.nx, map.ny, map.nz);
  for (int a = 0; a < 3; ++a) {
    expectWithin("a voxel's edge in metres", frame.voxelSizeM[a], kLeastVoxelM, kMostReachM);
    expectWithin("the map's reach in metres",
                 std::max(std::abs(frame.firstVoxelM[a]),
                          std::abs(frame.firstVoxelM[a] + voxels[a] * frame.voxelSizeM[a])),
                 0.0, kMostReachM);
  }
  DensityGrid g;
  g.grid = {map.nx, map.ny, map.nz, map.nx + field::kRowPadding, frame.firstVoxelM, frame.voxelSizeM};
  g.unit = std::ldexp(1.0, std::ilogb(largest));
  g.density.assign(g.grid.floats(), 0.0f);
  for (int z = 0; z < map.nz; ++z)
    for (int y = 0; y < map.ny; ++y)
      for (int x = 0; x < map.nx; ++x)
        g.density[g.grid.row(y, z) + static_cast<std::size_t>(x)] =
            static_cast<float>(static_cast<double>(map.at(x, y, z)) / g.unit);
  count(g);
  return g;
}

DensityGrid coarser(const DensityGrid& fine) {
  const BallGrid& from = fine.grid;
  const auto half = [](int n) { return n == 1 ? 1 : (n + 1) / 2; };
  DensityGrid g;
  g.unit = fine.unit;
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
