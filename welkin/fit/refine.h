// SPDX-License-Identifier: Apache-2.0
// Centres, radii and weights of all balls made better together. Private to fit/.
#pragma once

#include <span>
#include <vector>

#include "welkin/fit/ball_system.h"
#include "welkin/fit/fit_control.h"

namespace welkin::fit {

struct RefineParams {
  bool isSigned = false;
  double leastRadius = 1.0, greatestRadius = 1e9;
  int steps = 40;
  int innerSteps = 25;           // of conjugate gradients, for one step
  double innerTolerance = 0.05;  // of their preconditioned residual
  double tolerance = 1e-5;       // ends when a step takes off less than this share of |r|^2
};

// Levenberg and Marquardt's method (D. Marquardt 1963, "An Algorithm for Least-Squares Estimation of
// Nonlinear Parameters"), each step by conjugate gradients on J^T J + lambda D without forming it,
// preconditioned by each ball's own 5 x 5 block. Weights that may not be negative keep a tenth of themselves
// in a step, at least, so that they come near 0 but leave it again if they must. Returns |r|^2. If check
// throws, `balls` are the best so far.
double refine(const DensityGrid& data, std::vector<GridBall>& balls, const RefineParams& params,
              const FitControl& control);

}  // namespace welkin::fit
