// SPDX-License-Identifier: Apache-2.0
// Conversions between SI and the units that people type. Exact by definition unless said otherwise.
#pragma once

#include <numbers>

namespace welkin {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;             // radians in a degree
inline constexpr double kMetresPerFoot = 0.3048;           // international foot
inline constexpr double kMetresPerStatuteMile = 1609.344;  // international mile
inline constexpr double kMpsPerKnot = 1852.0 / 3600.0;     // international nautical mile an hour
inline constexpr double kMpsPerKmh = 1.0 / 3.6;
inline constexpr double kHpaPerInHg = 33.863886666667;  // conventional inch of mercury at 0 C
inline constexpr double kEarthRadiusM = 6371000.0;      // mean radius (IUGG R1, rounded)

constexpr double radians(double degrees) {
  return degrees * kDegree;
}
constexpr double degrees(double radians) {
  return radians / kDegree;
}

inline constexpr double kOktas = 8.0;       // make the whole sky
inline constexpr double kCoverDepth = 0.3;  // optical depth from which on observers call it cloud
// Of the air over the visibility that sky/ goes by, whose contrast is 2 % (H. Koschmieder 1924).
inline constexpr double kVisibilityDepth = 3.912;

}  // namespace welkin
