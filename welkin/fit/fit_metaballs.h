// SPDX-License-Identifier: Apache-2.0
// A cloud map made into metaballs (field/metaballs.h) that come as near to it as so many balls can, and how
// near that is.
//
// The method `refined`: clusters of voxels by density (k-means), balls with a multiple of their RMS radii,
// weights by least squares; then centres, radii and weights together by Levenberg and Marquardt's method,
// between rounds in which balls that do little are moved to where the residual is greatest. Large maps begin
// on coarser copies. `weights` ends after the least squares. `man` is P. Man 2006, "Generating and Real-Time
// Rendering of Clouds", as far as it went: online k-means of the voxels, R = 2 sigma, and here the one factor
// for all densities that fits best, since the paper gives none. Of given balls these two change the densities
// alone.
//
// The error is that over all voxels of the map, clear ones included: relative L2 = |field - map| / |map|.
//
// Deterministic: the same map, parameters and kind of processor give the same bits in any number of threads,
// unless a time limit cuts the fit short.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/image.h"
#include "welkin/core/params.h"
#include "welkin/field/metaballs.h"

namespace welkin::fit {

enum class FitMethod { kRefined, kWeights, kMan };

struct FitParams {
  FitMethod method = FitMethod::kRefined;
  bool isSigned = false;  // densities of balls may be negative; not with `man`
  std::int64_t seed = 0;
  std::optional<double> spread = {};      // radius of the first balls, of the RMS radius of their cluster
  double leastRadiusVoxels = 1.0;         // of a ball, in edges of a voxel
  double effort = 1.0;                    // factor of the rounds in which balls are moved
  std::optional<double> timeLimitS = {};  // for all levels together, shared out by their numbers of balls
};
void describe(FitParams& p, ParamVisitor& v);

// One level of detail.
struct FitLevel {
  std::size_t count = 0;  // of balls wanted
  std::vector<field::Metaball>
      balls;  // before: what to go on from, `count` of them, or none; after: the result
  double relativeL2 = 1.0;
  double rmse = 0.0;     // in the map's unit
  double seconds = 0.0;  // wall clock
  bool complete = false;
};

struct FitProgress {
  std::size_t level = 0;    // index of the level in work
  double fraction = 0.0;    // of that level, a guess
  double relativeL2 = 1.0;  // of the best so far, on the grid in work
};

// Fits every level, one by one. `progress` is called often, from the calling thread; it may throw to stop,
// and `levels` then hold the best so far, for which balls are there to be fitted again from.
//
// Throws ParameterError for a map that is empty, not finite or zero everywhere, and for a level of no balls,
// of more than the map has voxels that are not zero, or with balls to go on from that are not `count` valid
// ones, or negative without isSigned.
void fitMetaballs(const Volume<float>& map, const field::VoxelFrame& frame, const FitParams& params,
                  std::vector<FitLevel>& levels,
                  const std::function<void(const FitProgress&)>& progress = {});

}  // namespace welkin::fit

namespace welkin {
template <>
inline constexpr auto kEnumNames<fit::FitMethod> =
    std::to_array<std::string_view>({"refined", "weights", "man"});
}  // namespace welkin
