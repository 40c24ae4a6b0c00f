// SPDX-License-Identifier: Apache-2.0
// Clusters of a map's voxels, for balls to begin with. Private to fit/.
#pragma once

#include <cstdint>
#include <vector>

#include "welkin/fit/density_grid.h"
#include "welkin/fit/fit_control.h"

namespace welkin::fit {

struct Cluster {
  glm::dvec3 centre{0.0};
  double spread = 0.0;   // RMS distance of its voxels to the centre, metres; 0 for one voxel
  double density = 0.0;  // mean of its voxels
};

// k-means in which a voxel counts as much as its density (its magnitude), S. Lloyd 1982, "Least Squares
// Quantization in PCM". It begins at equal steps of the density along a space-filling curve (G. M. Morton
// 1966), shifted by the seed; the nearest centre is found exactly, through bins, so that a round takes about
// as long for many clusters as for few. `count` at most data.cloudVoxels. The same in any number of threads.
// Where control.late the centres are those so far.
std::vector<Cluster> clusters(const DensityGrid& data, std::size_t count, std::uint64_t seed,
                              const FitControl& control);

// The rule of P. Man 2006 after C. Darken and J. Moody 1990, "Fast adaptive k-means clustering": centres
// begin at random voxels; each voxel in turn draws the centre nearest to it nearer by eta = 1 / sqrt(n), n
// the voxels that centre has drawn so far; all voxels count the same. Voxels come in another random order in
// every epoch (in the order of the file, centres would follow the last slice), and epochs end when eta is
// below 0.02 on average, or after 40, or where control.late.
std::vector<Cluster> manClusters(const DensityGrid& data, std::size_t count, std::uint64_t seed,
                                 const FitControl& control);

}  // namespace welkin::fit
