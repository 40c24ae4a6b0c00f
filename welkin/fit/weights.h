// SPDX-License-Identifier: Apache-2.0
// The best weights for balls whose places and radii are given. Private to fit/.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "welkin/fit/ball_system.h"

namespace welkin::fit {

// Least squares over all voxels by the normal equations, which are sparse since only balls that overlap have
// a product. Signed: conjugate gradients. Otherwise none below 0: coordinate descent, which is exact for such
// problems (V. Franc, V. Hlavac and M. Navara 2005, "Sequential Coordinate-Wise Algorithm for the
// Non-negative Least Squares Problem"). Where `late` becomes true (FitControl) weights are those so far, or,
// with false, as they were.
bool solveWeights(const DensityGrid& data, std::span<GridBall> balls, bool isSigned,
                  const std::function<bool()>& late);

// One factor for all weights, the best.
void scaleWeights(const DensityGrid& data, std::span<GridBall> balls);

}  // namespace welkin::fit
