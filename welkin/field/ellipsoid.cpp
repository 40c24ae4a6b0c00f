// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace welkin::field {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

glm::dquat turn(double deg, const glm::dvec3& axis) {
  return glm::angleAxis(deg * kDegree, axis);
}

}  // namespace

void describe(Ellipsoid& e, ParamVisitor& v) {
  v.value({"centre_m", "m", "its centre: east, north, up from the middle of the cloud's base", -1e6, 1e6},
          e.centreM);
  v.value({"radii_m", "m", "half its lengths along its own axes", 0.01, 1e6}, e.radiiM);
  v.value({"rotation_deg", "deg", "turned about the x axis first, then y, then z", -360, 360}, e.rotationDeg);
}

glm::dquat frameFromEllipsoid(const Ellipsoid& e) {
  return turn(e.rotationDeg.z, {0, 0, 1}) * turn(e.rotationDeg.y, {0, 1, 0}) *
         turn(e.rotationDeg.x, {1, 0, 0});
}

glm::dvec3 rotationDegOf(const glm::dquat& rotation) {
  const glm::dmat3 r = glm::mat3_cast(glm::normalize(rotation));  // r[column][row]
  const double sinY = std::clamp(-r[0][2], -1.0, 1.0);
  // Looking straight along the axis the first and last turn are one: all of it goes to the last.
  if (std::abs(sinY) > 1.0 - 1e-12)
    return glm::dvec3(0.0, std::asin(sinY), std::atan2(-r[1][0], r[1][1])) / kDegree;
  return glm::dvec3(std::atan2(r[1][2], r[2][2]), std::asin(sinY), std::atan2(r[0][1], r[0][0])) / kDegree;
}

EllipsoidForm::EllipsoidForm(const Ellipsoid& e) : centre_(e.centreM) {
  const glm::dmat3 r = glm::mat3_cast(frameFromEllipsoid(e));
  const glm::dmat3 ownFromFrame = glm::transpose(r);
  glm::dmat3 scaled = ownFromFrame, reach = ownFromFrame;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      scaled[column][row] /= e.radiiM[row];
      reach[column][row] *= e.radiiM[row];
    }
  m_ = glm::transpose(scaled) * scaled;
  for (int axis = 0; axis < 3; ++axis) extent_[axis] = glm::length(reach[axis]);
}

double EllipsoidForm::q(const glm::dvec3& p) const {
  const glm::dvec3 d = p - centre_;
  return 1.0 - glm::dot(d, m_ * d);
}

EllipsoidForm::Line EllipsoidForm::alongX(double y, double z) const {
  const double dy = y - centre_.y, dz = z - centre_.z;
  const double linear = m_[0][1] * dy + m_[0][2] * dz;
  const double rest = m_[1][1] * dy * dy + 2.0 * m_[1][2] * dy * dz + m_[2][2] * dz * dz;
  return {centre_.x - linear / m_[0][0], rest - linear * linear / m_[0][0], m_[0][0]};
}

Box boundsOf(std::span<const Ellipsoid> ellipsoids) {
  Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
  for (const Ellipsoid& e : ellipsoids) {
    const EllipsoidForm form(e);
    box.low = glm::min(box.low, form.centreM() - form.extentM());
    box.high = glm::max(box.high, form.centreM() + form.extentM());
  }
  return box;
}

}  // namespace welkin::field
