// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/planets.h"

#include <erfa.h>
#include <erfam.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "welkin/core/units.h"

namespace welkin::sky {
namespace {

// A planet as sun and earth see it.
struct Circumstances {
  double phaseDeg = 0.0;                   // sun-planet-earth
  double sunTiltDeg = 0.0, tiltDeg = 0.0;  // planetocentric latitude of the sun and of the earth
};

struct PlanetKind {
  std::string_view name;
  int number;                    // ERFA's, from the sun
  double radiusM;                // IAU 2015 Working Group on Cartographic Coordinates
  double colour;                 // D. L. Harris 1961, "Photometry and colorimetry of planets and satellites"
  double poleRaDeg, poleDecDeg;  // north pole of 2000, IAU 2015; used where brightness hangs on it
  double (*unitMagnitude)(const Circumstances&);  // one au from sun and earth
};

double mercury(const Circumstances& c) {
  const double a = c.phaseDeg;
  return -0.613 +
         a * (6.3280e-2 +
              a * (-1.6336e-3 + a * (3.3644e-5 + a * (-3.4265e-7 + a * (1.6893e-9 - a * 3.0334e-12)))));
}

double venus(const Circumstances& c) {
  const double a = c.phaseDeg;
  if (a >= 163.7) return 236.05828 + a * (-2.81914 + a * 8.39034e-3);
  return -4.384 + a * (-1.044e-3 + a * (3.687e-4 + a * (-2.814e-6 + a * 8.938e-9)));
}

double mars(const Circumstances& c) {
  const double a = c.phaseDeg;
  return a <= 50.0 ? -1.601 + a * (2.267e-2 - a * 1.302e-4) : -0.367 + a * (-0.02573 + a * 3.445e-4);
}

double jupiter(const Circumstances& c) {  // from the earth never past 12 degrees
  const double a = c.phaseDeg;
  return -9.395 + a * (-3.7e-4 + a * 6.16e-4);
}

// With its rings, which are dark to us when the sun is on their other side.
double saturn(const Circumstances& c) {
  const double product = c.sunTiltDeg * c.tiltDeg;
  const double tilt = std::sin(radians(product > 0.0 ? std::sqrt(product) : 0.0));
  return -8.914 - 1.825 * tilt + 0.026 * c.phaseDeg - 0.378 * tilt * std::exp(-2.25 * c.phaseDeg);
}

double uranus(const Circumstances& c) {  // its poles are brighter; its phase, 3 degrees at most, is nothing
  return -7.110 - 4.2e-4 * (std::abs(c.sunTiltDeg) + std::abs(c.tiltDeg));
}

constexpr std::array<PlanetKind, kPlanetCount> kPlanets{{
    {"mercury", 1, 2440.5e3, 0.93, 281.01, 61.42, mercury},
    {"venus", 2, 6051.8e3, 0.82, 272.76, 67.16, venus},
    {"mars", 4, 3396.2e3, 1.36, 317.68, 52.89, mars},
    {"jupiter", 5, 71492e3, 0.83, 268.06, 64.50, jupiter},
    {"saturn", 6, 60268e3, 1.04, 40.589, 83.537, saturn},
    {"uranus", 7, 25559e3, 0.56, 257.311, -15.175, uranus},
}};

double angleDeg(const glm::dvec3& a, const glm::dvec3& b) {
  return degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

}  // namespace

std::array<PlanetPlace, kPlanetCount> planetPlaces(double ttDay, double ttFraction,
                                                   const glm::dvec3& earthAu) {
  std::array<PlanetPlace, kPlanetCount> places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PlanetKind& planet = kPlanets[i];
    glm::dvec3 planetAu(0.0), fromEarthAu(0.0);
    double lightDays = 0.0;
    for (int pass = 0; pass < 3; ++pass) {  // each 1e4 times as near
      double pv[2][3];
      eraPlan94(ttDay, ttFraction - lightDays, planet.number, pv);
      planetAu = {pv[0][0], pv[0][1], pv[0][2]};
      fromEarthAu = planetAu - earthAu;
      lightDays = glm::length(fromEarthAu) * ERFA_AULT / ERFA_DAYSEC;
    }
    const double ra = radians(planet.poleRaDeg), dec = radians(planet.poleDecDeg);
    const glm::dvec3 pole(std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec));
    const Circumstances c{angleDeg(planetAu, fromEarthAu), angleDeg(pole, planetAu) - 90.0,
                          angleDeg(pole, fromEarthAu) - 90.0};
    const double distances = glm::length(planetAu) * glm::length(fromEarthAu);
    places[i] = {planet.name, fromEarthAu, planet.radiusM,
                 planet.unitMagnitude(c) + 5.0 * std::log10(distances), planet.colour};
  }
  return places;
}

}  // namespace welkin::sky
