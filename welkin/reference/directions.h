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

// Cosine and sine of the share u of a circle, [0, 1), within 1e-11: faster than any function for all angles.
struct OnCircle {
  double cosine, sine;
};
inline OnCircle onCircle(double u) {
  // Of an eighth of the circle to either side of an axis, by series.
  const int quarter = static_cast<int>(8.0 * u + 1.0) >> 1;
  const double x = (4.0 * u - quarter) * (0.5 * kPi), x2 = x * x;
  const double s = x *
                   (1.0 - x2 / 6.0 *
                              (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0))))),
               c = 1.0 -
                   x2 / 2.0 *
                       (1.0 -
                        x2 / 12.0 *
                            (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0 * (1.0 - x2 / 90.0 * (1.0 - x2 / 132.0)))));
  const bool swapped = quarter & 1;
  const double along = swapped ? -s : c, across = swapped ? c : s;
  return quarter & 2 ? OnCircle{-along, -across} : OnCircle{along, across};
}

// `w` turned by the angle whose cosine and sine are given, about itself by a place on a circle.
inline glm::dvec3 turned(const glm::dvec3& w, double cosine, double sine, const OnCircle& about) {
  // An orthonormal basis without a branch: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
  const double sign = std::copysign(1.0, w.z);
  const double a = -1.0 / (sign + w.z), b = w.x * w.y * a;
  const glm::dvec3 s(1.0 + sign * w.x * w.x * a, sign * b, -sign * w.x), t(b, sign + w.y * w.y * a, -w.y);
  return glm::normalize(sine * about.cosine * s + sine * about.sine * t + cosine * w);
}
// phi: rad.
inline glm::dvec3 turned(const glm::dvec3& w, double cosine, double phi) {
  return turned(w, cosine, std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), {std::cos(phi), std::sin(phi)});
}
// By an angle of this versine, 1 - cosine, [0, 2], to any side.
inline glm::dvec3 turnedAnywhere(const glm::dvec3& w, double versine, Random& random) {
  return turned(w, 1.0 - versine, std::sqrt(versine * (2.0 - versine)), onCircle(unit(random)));
}

// About `up`, as a diffuse surface reflects: density cosine / pi.
inline glm::dvec3 lambertDirection(const glm::dvec3& up, Random& random) {
  const double u = unit(random), cosine = std::sqrt(std::max(1.0 - u, 1e-12));
  return turned(up, cosine, std::sqrt(u), onCircle(unit(random)));
}

}  // namespace welkin::reference
