// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/stars.h"

#include <erfa.h>
#include <erfam.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "welkin/core/colour.h"
#include "welkin/core/units.h"

namespace welkin::sky {
namespace {

constexpr CatalogueStar kStars[] = {
#include "welkin/sky/star_catalogue.inc"
};

}  // namespace

std::span<const CatalogueStar> starCatalogue() {
  return kStars;
}

double starIlluminanceLux(double magnitude) {
  return 2.54e-6 * std::pow(10.0, -0.4 * magnitude);
}

double starTemperatureK(double colour) {
  return 4600.0 * (1.0 / (0.92 * colour + 1.7) + 1.0 / (0.92 * colour + 0.62));
}

// Chromaticity by B. Kang et al. 2002, "Design of Advanced Color Temperature Control System for HDTV
// Applications", J. Korean Phys. Soc. 41, 865.
glm::vec3 blackBodyColour(double temperatureK) {
  const double k = std::clamp(temperatureK, 1667.0, 25000.0), t = 1e3 / k;
  const double x = k < 4000.0 ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910
                              : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390;
  const double y = k < 2222.0   ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                   : k < 4000.0 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                                : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
  const glm::dvec3 rgb = glm::max(rgbFromXyz({x / y, 1.0, (1.0 - x - y) / y}), glm::dvec3(0.0));
  return glm::vec3(rgb / luminanceOf(&rgb.x));
}

std::vector<StarLight> starLights(const UtcTime& time) {
  double mjdZero = 0.0, mjd = 0.0;
  eraCal2jd(time.year, time.month, time.day, &mjdZero, &mjd);
  const double day = (time.hour * 3600.0 + time.minute * 60.0 + time.second) / ERFA_DAYSEC;
  const double years = (mjdZero - ERFA_DJ00 + mjd + day) / ERFA_DJY;  // that UTC is not TT is nothing here
  double heliocentric[2][3], barycentric[2][3];
  eraEpv00(mjdZero, mjd + day, heliocentric, barycentric);
  const double lightSpeed = ERFA_DAYSEC / ERFA_AULT;  // AU a day
  const glm::dvec3 velocity =
      glm::dvec3(barycentric[1][0], barycentric[1][1], barycentric[1][2]) / lightSpeed;

  std::vector<StarLight> lights;
  lights.reserve(std::size(kStars));
  for (const CatalogueStar& star : kStars) {
    const double ra = radians(1e-4 * star.rightAscension), dec = radians(1e-4 * star.declination);
    const glm::dvec3 direction(std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec));
    const glm::dvec3 east(-std::sin(ra), std::cos(ra), 0.0), north = glm::cross(direction, east);
    const glm::dvec3 moved =
        years * ERFA_DMAS2R *
        (static_cast<double>(star.motionEast) * east + static_cast<double>(star.motionNorth) * north);
    StarLight light;
    light.direction = glm::normalize(glm::normalize(direction + moved) + velocity);
    light.magnitude = 0.01 * star.magnitude;
    light.illuminance = static_cast<float>(starIlluminanceLux(light.magnitude)) *
                        blackBodyColour(starTemperatureK(0.01 * star.colour));
    lights.push_back(light);
  }
  return lights;
}

}  // namespace welkin::sky
