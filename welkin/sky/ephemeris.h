// SPDX-License-Identifier: Apache-2.0
// Where sun, moon and planets stand. Geometric directions without refraction, topocentric (the moon's
// parallax matters: up to 1 degree).
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string_view>

#include "welkin/core/utc_time.h"
#include "welkin/sky/eclipse.h"
#include "welkin/sky/planets.h"

namespace welkin::sky {

struct Observer {
  double latitudeDeg = 0.0;   // geodetic, north positive
  double longitudeDeg = 0.0;  // east positive
  double altitudeM = 0.0;
};

struct Body {
  double azimuthDeg = 0.0;    // clockwise from north, [0, 360)
  double elevationDeg = 0.0;  // above the horizon
  double distanceM = 0.0;     // from the observer
  double angularRadiusRad = 0.0;
  glm::dvec3 direction{0, 0, 1};  // unit, east-north-up
};

struct Planet {
  std::string_view name;  // in lower case
  Body body;
  double magnitude = 0.0;  // V
  double colour = 0.0;     // B-V
};

struct Ephemeris {
  Body sun;
  Body moon;
  std::array<Planet, kPlanetCount> planets;  // from the sun outwards: Mercury, Venus, Mars to Uranus
  double moonIlluminatedFraction = 0.0;      // 0 new, 1 full
  double moonPhaseAngleRad = 0.0;            // sun-moon-observer; 0 full, pi new
  double moonIlluminanceLux = 0.0;           // above the atmosphere, facing the moon; eclipsed
  double sunIlluminanceLux = 0.0;            // above the atmosphere, facing the sun; eclipsed
  SolarEclipse solarEclipse;                 // in east-north-up
  LunarEclipse lunarEclipse;                 // in east-north-up
  glm::dmat3 enuFromCelestial{1.0};          // directions from the celestial system (GCRS) to east-north-up
};

Ephemeris ephemeris(const UtcTime& time, const Observer& observer);

// How high the sun would leave the sky about as dark as it is: its elevation, but in a total eclipse of the
// sun as in deep twilight, with stars.
double darknessElevationDeg(const Ephemeris& e);

}  // namespace welkin::sky
