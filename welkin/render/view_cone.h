// SPDX-License-Identifier: Apache-2.0
// The cone around a picture, to tell what may be in it.
#pragma once

#include <glm/vec3.hpp>

#include "welkin/shading/view.h"

namespace welkin::render {

struct ViewCone {
  glm::dvec3 axis;
  double halfAngle;
};
ViewCone coneOf(const shading::ViewParts& view);

// Whether a ball, its centre from the eye, is in it in part.
bool mayBeSeen(const ViewCone& cone, const glm::dvec3& centreM, double radiusM);

}  // namespace welkin::render
