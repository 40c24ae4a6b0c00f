// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/wind.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/units.h"

namespace welkin::weather {
namespace {

constexpr double kBoundaryLayerM = 1000.0;
constexpr double kAnemometerM = 10.0;
constexpr double kThermalWindTopM = 11000.0;
constexpr double kStrongestMps = 120.0;  // jet streams and tornadic storms included

}  // namespace

glm::dvec2 windTowards(double fromDeg) {
  const double towards = radians(fromDeg + 180.0);
  return {std::sin(towards), std::cos(towards)};
}

double winterness(double latitudeDeg, int month) {
  const double northern = 0.5 + 0.5 * std::cos(2.0 * kPi * (month - 1) / 12.0);
  return latitudeDeg >= 0.0 ? northern : 1.0 - northern;
}

Wind windAloft(const Wind& surface, double heightM, double latitudeDeg, int month) {
  const double lowM = std::clamp(heightM, kAnemometerM, kBoundaryLayerM);
  const double speed = surface.speedMps * std::pow(lowM / kAnemometerM, 1.0 / 7.0);
  const double veerDeg = 25.0 * std::clamp(latitudeDeg / 30.0, -1.0, 1.0) * (lowM - kAnemometerM) /
                         (kBoundaryLayerM - kAnemometerM);
  const double from = radians(surface.fromDeg + veerDeg);
  double east = -speed * std::sin(from);
  const double north = -speed * std::cos(from);

  const double distance = (std::abs(latitudeDeg) - 45.0) / 20.0;
  const double shearPerKm = (1.5 + winterness(latitudeDeg, month)) * std::exp(-distance * distance);
  east += shearPerKm * std::max(std::min(heightM, kThermalWindTopM) - kBoundaryLayerM, 0.0) / 1000.0;

  Wind wind;
  const double speedMps = std::hypot(east, north);
  wind.speedMps = std::min(speedMps, kStrongestMps);
  wind.fromDeg = surface.fromDeg;
  if (speedMps > 1e-9) {
    wind.fromDeg = degrees(std::atan2(-east, -north));
    if (wind.fromDeg < 0.0) wind.fromDeg += 360.0;
  }
  return wind;
}

}  // namespace welkin::weather
