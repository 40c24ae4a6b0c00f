// SPDX-License-Identifier: Apache-2.0
// Ellipsoids, of which clouds are built: G. Gardner 1985, "Visual Simulation of Clouds"; P. Man 2006.
//
// Frame: x east, y north, z up, metres, from the middle of the cloud's base.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "welkin/core/params.h"

namespace welkin::field {

struct Ellipsoid {
  glm::dvec3 centreM{0.0};
  glm::dvec3 radiiM{100.0};     // along its own axes, each > 0
  glm::dvec3 rotationDeg{0.0};  // turns about the fixed x axis first, then y, then z; right-handed
};
void describe(Ellipsoid& e, ParamVisitor& v);

// The rotation that takes the ellipsoid's own axes to the frame's, and back to angles (y within +-90).
glm::dquat frameFromEllipsoid(const Ellipsoid& e);
glm::dvec3 rotationDegOf(const glm::dquat& frameFromEllipsoid);

// Man's Q, a quadratic form ready for many points: 1 at the centre, 0 on the surface, negative outside.
class EllipsoidForm {
 public:
  explicit EllipsoidForm(const Ellipsoid& e);

  double q(const glm::dvec3& p) const;

  // Half the size of the box around it.
  const glm::dvec3& extentM() const { return extent_; }
  const glm::dvec3& centreM() const { return centre_; }

  // On the line along x at (y, z): q = 1 - nearest - curvature (x - xMiddle)^2.
  struct Line {
    double xMiddle, nearest, curvature;
  };
  Line alongX(double y, double z) const;

 private:
  glm::dvec3 centre_, extent_;
  glm::dmat3 m_;  // symmetric: q = 1 - d^T m d
};

// The box around all of them: least and greatest corner.
struct Box {
  glm::dvec3 low, high;
};
Box boundsOf(std::span<const Ellipsoid> ellipsoids);  // at least one

}  // namespace welkin::field
