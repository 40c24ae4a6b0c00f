// SPDX-License-Identifier: Apache-2.0
// Straight ways over the curved ground, in double precision.
//
// Frame: east-north-up, metres, origin on the ground under the eye; the ground is a sphere. A height is that
// above it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace welkin::reference {

struct Ray {
  glm::dvec3 from{0.0};
  glm::dvec3 way{0.0, 0.0, 1.0};  // unit
  glm::dvec3 at(double t) const { return from + way * t; }
};

class Sphere {
 public:
  explicit Sphere(double radiusM) : radius_(radiusM), inverse_(1.0 / radiusM) {}
  double radiusM() const { return radius_; }

  glm::dvec3 centre() const { return {0.0, 0.0, -radius_}; }
  glm::dvec3 up(const glm::dvec3& p) const { return glm::normalize(p - centre()); }
  double height(const glm::dvec3& p) const {
    const double e = excess(p), x = e * inverse_ * inverse_;
    // Within 200 km of the ground a series is as exact as the root.
    if (std::abs(x) < 0.06)
      return e * inverse_ *
             (0.5 - x * (0.125 - x * (0.0625 - x * (5.0 / 128 - x * (7.0 / 256 - x * (21.0 / 1024))))));
    return e / (std::sqrt(radius_ * radius_ + e) + radius_);
  }
  // Cosine of the angle between a direction and the zenith at p.
  double cosine(const glm::dvec3& p, const glm::dvec3& w) const {
    return along(p, w) / std::sqrt(radius_ * radius_ + excess(p));
  }

  bool rises(const Ray& ray) const { return along(ray.from, ray.way) > 0.0; }

  // Where a line crosses the sphere of a height, near < far; false: nowhere.
  bool crossings(const Ray& ray, double heightM, double& near, double& far) const {
    const double b = along(ray.from, ray.way), c = excess(ray.from) - heightM * (2.0 * radius_ + heightM);
    const double disc = b * b - c;
    if (disc <= 0.0) return false;
    const double q = b > 0.0 ? -b - std::sqrt(disc) : -b + std::sqrt(disc);
    const double other = q != 0.0 ? c / q : 0.0;
    near = std::min(q, other);
    far = std::max(q, other);
    return true;
  }
  // Distance to the ground; `none` where the ray misses it. On the ground itself, only ways down meet it.
  double toGround(const Ray& ray, double none) const {
    double near = 0.0, far = 0.0;
    if (along(ray.from, ray.way) >= 0.0 || !crossings(ray, 0.0, near, far)) return none;
    return std::max(near, 0.0);
  }

 private:
  double excess(const glm::dvec3& p) const {  // |p - centre|^2 - radius^2
    return p.z * (2.0 * radius_ + p.z) + p.x * p.x + p.y * p.y;
  }
  double along(const glm::dvec3& p, const glm::dvec3& w) const {
    return p.x * w.x + p.y * w.y + (radius_ + p.z) * w.z;
  }
  double radius_, inverse_;
};

}  // namespace welkin::reference
