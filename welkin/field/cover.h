// SPDX-License-Identifier: Apache-2.0
// How much of the sky clouds hide, and the threshold that makes them hide as much as was asked for.
//
// Cover is what an observer on the ground calls so: the fraction of the sky hemisphere, by solid angle, in
// whose directions the optical depth exceeds 0.3. It is measured on the field itself, from the place where
// the weather is reported.
#pragma once

#include <span>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"

namespace welkin::field {

inline constexpr auto kCoverOpticalDepth = static_cast<float>(kCoverDepth);

// Where and how finely to look.
struct CoverView {
  double eyeM = 2.0;      // above the ground
  int directions = 1500;  // spread evenly over the hemisphere
};

// Direction i of n, evenly over the upper hemisphere.
glm::vec3 hemisphereDirection(int i, int n);

// Fraction in [0, 1]; `only` picks one layer, -1: all together.
double measureCover(const CloudField& field, const CoverView& view, int only = -1);

// Optical depth of one layer in each direction of the view, followed no further than to kCoverOpticalDepth.
// Where the depths of several layers add up to that, the sky is covered: so layers measured one by one tell
// what they hide together.
std::vector<float> layerOpticalDepths(const CloudField& field, const CoverView& view, int layer);

// Fraction of directions in which the optical depth makes cover.
double coverOf(std::span<const float> opticalDepths);

// Where calibrated() ends for layers that cannot cover what is asked: cloud wherever the layer reaches.
inline constexpr float kLeastThreshold = -4.0f;

// The layer's threshold at which its own measured cover is `fraction`, by bisection (cover falls as the
// threshold rises). Where the layer is too thin to reach it, its extinction is raised. The other layers do
// not matter.
CloudLayer calibrated(const CloudField& field, int layer, double fraction, const CoverView& view);

}  // namespace welkin::field
