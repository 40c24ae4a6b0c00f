// SPDX-License-Identifier: Apache-2.0
// A map as the fit works on it: rows padded for vectors, and coarser copies for the beginning of a fit with
// many voxels a ball. Private to fit/.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/field/metaballs.h"
#include "welkin/fit/ball_kernels.h"

namespace welkin::fit {

inline double square(const glm::dvec3& v) {
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

struct DensityGrid {
  BallGrid grid;                 // metres
  std::vector<float> density;    // in `unit`s; the padding is 0
  double unit = 1.0;             // of the map's: a power of two, so that the largest is from 1 to 2
  double squares = 0.0;          // the sum of their squares
  std::int64_t cloudVoxels = 0;  // those that are not 0

  std::int64_t voxels() const { return std::int64_t{grid.nx} * grid.ny * grid.nz; }
};

// Throws ParameterError for a map without voxels, with a density that is not finite (and says where), with
// none but zero, or with sizes or densities so large or small that balls could not be told by floats.
DensityGrid densityGrid(const Volume<float>& map, const field::VoxelFrame& frame);

// Means of 2 x 2 x 2 voxels; where a size is odd, with clear air beyond the far face. An axis of one voxel
// stays.
DensityGrid coarser(const DensityGrid& fine);

}  // namespace welkin::fit
