// SPDX-License-Identifier: Apache-2.0
// The planets that the naked eye sees: where they stand as seen from the earth, and how bright they are.
//
// Places: J. L. Simon et al. 1994, "Numerical expressions for precession formulae and mean elements for the
// Moon and the planets", as ERFA has it: elements of the orbits and their largest perturbations. From 1800 to
// 2050 longitudes about the sun are right within 0.025 degrees; to 2100 places are within 2 arc minutes of
// those by VSOP87 (P. Bretagnon and G. Francou 1988). Light time is in them.
//
// Magnitudes: A. Mallama and J. L. Hilton 2018, "Computing apparent planetary magnitudes for The Astronomical
// Almanac", without the faces that Mars turns to us (0.06 magnitudes) and its seasons.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string_view>

namespace welkin::sky {

constexpr int kPlanetCount =
    6;  // from the sun outwards, the earth left out; Uranus is the last above V = 6.5

struct PlanetPlace {
  std::string_view name;            // in lower case
  glm::dvec3 fromEarthAu{0, 0, 1};  // in the celestial system (GCRS), before aberration
  double radiusM = 0.0;             // of its equator
  double magnitude = 0.0;           // V
  double colour = 0.0;              // B-V
};

// At a Julian date in terrestrial time, of two parts; earthAu: the earth about the sun, in the same system.
std::array<PlanetPlace, kPlanetCount> planetPlaces(double ttDay, double ttFraction,
                                                   const glm::dvec3& earthAu);

}  // namespace welkin::sky
