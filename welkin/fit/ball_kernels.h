// SPDX-License-Identifier: Apache-2.0
// The inner loops of a fit: what a change of one ball does to a grid of voxels, and what the grid says to the
// ball. Private to fit/.
//
// A ball's term is w f(s), s = |x - c|^2 / R^2. With g = df/ds, d = x - c its derivatives are
//   by w: f        by c: -2 w / R^2 g d        by ln R: -2 w g s
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "welkin/field/metaball_grid.h"

namespace welkin::fit {

using field::BallGrid;
using field::GridBall;
using field::SliceRange;

// A change of one ball.
struct BallStep {
  double weight = 0.0;
  glm::dvec3 centre{0.0};
  double logRadius = 0.0;
};

// Adds the derivative of the ball's term along the step.
void addBallStep(const BallGrid& grid, const GridBall& ball, const BallStep& step, SliceRange slices,
                 float* voxels);

// The derivatives of the ball's term, multiplied by r and summed over the voxels.
BallStep gatherBall(const BallGrid& grid, const GridBall& ball, const float* r);

// Sums over the voxels of f r and f f: with the weight -fr / ff the ball would take fr^2 / ff off |r|^2.
struct BallGain {
  double fr = 0.0, ff = 0.0;
};
BallGain gainOfBall(const BallGrid& grid, const GridBall& ball, const float* r);

// Sums of the products of the five derivatives, row by row: the ball's own block of J^T J.
using BallBlock = std::array<double, 25>;
BallBlock blockOfBall(const BallGrid& grid, const GridBall& ball);

}  // namespace welkin::fit
