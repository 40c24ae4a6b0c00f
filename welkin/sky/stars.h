// SPDX-License-Identifier: Apache-2.0
// The stars that the naked eye sees: places, brightness and colour. Directions are geometric, without
// refraction. Double stars that Hipparcos took for one are one. No planets.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "welkin/core/utc_time.h"

namespace welkin::sky {

// As catalogued: ESA 1997, "The Hipparcos and Tycho Catalogues", ESA SP-1200.
struct CatalogueStar {
  int rightAscension = 0, declination = 0;  // 1e-4 degrees, J2000
  int motionEast = 0, motionNorth = 0;      // mas a year
  int magnitude = 0, colour = 0;            // V and B-V, hundredths
};
// All to V = 6.5, the brightest first.
std::span<const CatalogueStar> starCatalogue();

// A star as a light.
struct StarLight {
  glm::dvec3 direction{0, 0, 1};  // unit, in the celestial system (GCRS); Ephemeris has the way from there
  glm::vec3 illuminance{0};       // above the atmosphere, facing it, lux, linear Rec. 709
  double magnitude = 0.0;         // V
};
// Of the catalogue, in its order, with proper motion and annual aberration to the time.
std::vector<StarLight> starLights(const UtcTime& time);

// Above the atmosphere. V = 0 gives 2.54e-6 lux: C. W. Allen 1973, "Astrophysical Quantities", 3rd ed., 98.
double starIlluminanceLux(double magnitude);

// Of a star's B-V: F. J. Ballesteros 2012, "New insights into black bodies", EPL 97, 34008, eq. 14.
double starTemperatureK(double colour);

// Linear Rec. 709 of luminance 1 of a black body. Temperatures are brought into 1,667 to 25,000 K.
glm::vec3 blackBodyColour(double temperatureK);

}  // namespace welkin::sky
