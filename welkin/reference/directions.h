// SPDX-License-Identifier: Apache-2.0
// Random directions about others, and the numbers that they are made of.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "welkin/core/random.h"
#include "welkin/core/units.h"

namespace welkin::reference {

inline double unit(Random& random) {  // [0, 1)
  return static_cast<double>(random.next() >> 11) * 0x1p-53;
}

// `w` turned by the angle whose cosine is given, about itself by phi.
inline glm::dvec3 turned(const glm::dvec3& w, double cosine, double phi) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  // An orthonormal basis without a branch: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
  const double sign = std::copysign(1.0, w.z);
  const double a = -1.0 / (sign + w.z), b = w.x * w.y * a;
  const glm::dvec3 s(1.0 + sign * w.x * w.x * a, sign * b, -sign * w.x), t(b, sign + w.y * w.y * a, -w.y);
  return glm::normalize(sine * std::cos(phi) * s + sine * std::sin(phi) * t + cosine * w);
}

// About `up`, as a diffuse surface reflects: density cosine / pi.
inline glm::dvec3 lambertDirection(const glm::dvec3& up, Random& random) {
  const double u = unit(random);
  return turned(up, std::sqrt(std::max(1.0 - u, 1e-12)), 2.0 * kPi * unit(random));
}

}  // namespace welkin::reference
