// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/ephemeris.h"

#include <erfa.h>
#include <erfam.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "welkin/core/colour.h"
#include "welkin/core/units.h"
#include "welkin/sky/light.h"

namespace welkin::sky {
namespace {

constexpr double kMoonMeanDistanceM = 384.4e6;
constexpr double kLightSecondsPerAu = ERFA_AULT;

// Illuminance outside the atmosphere at one astronomical unit: the solar constant 1361 W/m2 at 97.8 lm/W (DIN
// 5034-2 uses 133.8 klx, IES 133.1 klx).
constexpr double kSunIlluminanceLux = 133100.0;

// Illuminance by the moon at its mean distance as the phase angle goes to zero, opposition surge left out.
// With the 10 % that a clear atmosphere keeps back at 60 degrees this gives the 0.216 lux of USNO Circular
// 171.
constexpr double kFullMoonIlluminanceLux = 0.279;

// TT - UT1 in seconds at the beginning of 1950, 1952, ... 2026, as observed (IERS, USNO).
constexpr std::array<double, 39> kDeltaT = {
    28.93, 29.70, 30.20, 30.76, 32.03, 33.07, 33.62, 34.44, 35.95, 37.96, 39.93, 42.15, 44.48,
    46.46, 48.53, 50.54, 52.17, 53.79, 54.87, 55.82, 56.86, 58.31, 59.98, 61.63, 62.97, 63.83,
    64.30, 64.57, 64.85, 65.46, 66.07, 66.60, 67.28, 68.10, 68.97, 69.36, 69.29, 69.18, 69.11};

// TT - UT1 in seconds. Before the table a line through 1900's -2.8 s serves: the sun moves 0.04 arc seconds a
// second. After it nobody knows: predictions of UT1 - UTC for 2050 lie between 0, if leap seconds go on, and
// -2.3 s; the middle way turns the sky by less than 0.005 degrees from both.
double deltaTSeconds(double year) {
  constexpr double kFirst = 1950.0, kStep = 2.0;
  constexpr double kLast = kFirst + kStep * (kDeltaT.size() - 1);
  if (year < kFirst) return -2.8 + (year - 1900.0) / 50.0 * (kDeltaT.front() + 2.8);
  if (year >= kLast) return kDeltaT.back() + 0.047 * (year - kLast);
  const double x = (year - kFirst) / kStep;
  const auto i = static_cast<std::size_t>(x);
  return kDeltaT[i] + (kDeltaT[i + 1] - kDeltaT[i]) * (x - static_cast<double>(i));
}

// A Julian date in the two parts that ERFA likes.
struct JulianDate {
  double day = 0.0;       // ends in .5: midnight
  double fraction = 0.0;  // of a day
};

JulianDate julianDate(const UtcTime& t) {
  double mjdZero = 0.0, mjd = 0.0;
  eraCal2jd(t.year, t.month, t.day, &mjdZero, &mjd);
  return {mjdZero + mjd, (t.hour * 3600.0 + t.minute * 60.0 + t.second) / ERFA_DAYSEC};
}

double decimalYear(const UtcTime& t) {
  return t.year + (t.month - 1 + (t.day - 1) / 31.0) / 12.0;
}

// The two clocks that the sky needs: terrestrial time for the orbits, universal time for the earth's turning.
struct Clocks {
  JulianDate tt, ut1;
};

// Since 1972 UTC leads to TT by the leap seconds that ERFA knows (after its last one the offset stays) and
// from there to UT1. Before, UTC is read as UT1.
Clocks clocksAt(const UtcTime& t) {
  const JulianDate utc = julianDate(t);
  const double deltaT = deltaTSeconds(decimalYear(t));
  double leapSeconds = 0.0;
  if (t.year >= 1972)
    eraDat(t.year, t.month, t.day, 0.0, &leapSeconds);  // only warns about years beyond its table
  const double ttMinusUtc = t.year >= 1972 ? leapSeconds + ERFA_TTMTAI : deltaT;
  return {{utc.day, utc.fraction + ttMinusUtc / ERFA_DAYSEC},
          {utc.day, utc.fraction + (ttMinusUtc - deltaT) / ERFA_DAYSEC}};
}

glm::dvec3 toVec(const double p[3]) {
  return {p[0], p[1], p[2]};
}

Body bodyAt(const glm::dvec3& enuM, double radiusM) {
  Body b;
  b.distanceM = glm::length(enuM);
  b.direction = enuM / b.distanceM;
  b.elevationDeg = degrees(std::atan2(b.direction.z, std::hypot(b.direction.x, b.direction.y)));
  b.azimuthDeg = degrees(std::atan2(b.direction.x, b.direction.y));
  if (b.azimuthDeg < 0.0) b.azimuthDeg += 360.0;
  if (b.azimuthDeg >= 360.0) b.azimuthDeg = 0.0;
  b.angularRadiusRad = std::asin(std::min(radiusM / b.distanceM, 1.0));
  return b;
}

// Magnitudes lost at a phase angle: C. W. Allen 1976, "Astrophysical Quantities", as given by K. Krisciunas
// and B. E. Schaefer 1991, "A model of the brightness of moonlight", eq. 9.
double moonPhaseMagnitudes(double phaseAngleRad) {
  const double a = degrees(std::abs(phaseAngleRad));
  return 0.026 * a + 4.0e-9 * a * a * a * a;
}

}  // namespace

Ephemeris ephemeris(const UtcTime& time, const Observer& observer) {
  const auto [tt, ut1] = clocksAt(time);  // TDB differs from TT by 2 ms at most

  // Sun and planets: astrometric direction of date, then annual aberration (20 arc seconds) from the earth's
  // barycentric velocity.
  double pvHeliocentric[2][3], pvBarycentric[2][3];
  eraEpv00(tt.day, tt.fraction, pvHeliocentric, pvBarycentric);
  const glm::dvec3 earthAu = toVec(pvHeliocentric[0]);
  const double sunDistanceAu = glm::length(earthAu);
  double velocity[3];
  for (int i = 0; i < 3; ++i)
    velocity[i] = pvBarycentric[1][i] * kLightSecondsPerAu / ERFA_DAYSEC;  // in units of c
  const double lorentz = std::sqrt(1.0 - glm::dot(toVec(velocity), toVec(velocity)));
  const auto apparentM = [&](const glm::dvec3& fromEarthAu) {
    const double distanceAu = glm::length(fromEarthAu);
    double natural[3], proper[3];
    for (int i = 0; i < 3; ++i) natural[i] = fromEarthAu[i] / distanceAu;
    eraAb(natural, velocity, sunDistanceAu, lorentz, proper);
    return toVec(proper) * (distanceAu * ERFA_DAU);
  };
  const glm::dvec3 sunGcrsM = apparentM(-earthAu);

  // Moon: it shares the earth's motion, so light time and aberration together are its own motion during 1.3
  // s.
  double pvMoon[2][3];
  eraMoon98(tt.day, tt.fraction, pvMoon);
  const double moonLightDays = glm::length(toVec(pvMoon[0])) * kLightSecondsPerAu / ERFA_DAYSEC;
  const glm::dvec3 moonGcrsM = (toVec(pvMoon[0]) - toVec(pvMoon[1]) * moonLightDays) * ERFA_DAU;

  // Celestial to terrestrial by IAU 2006/2000A precession-nutation; polar motion (0.3 arc seconds) is left
  // out.
  double terrestrialFromCelestial[3][3];
  eraC2t06a(tt.day, tt.fraction, ut1.day, ut1.fraction, 0.0, 0.0, terrestrialFromCelestial);
  double site[3];
  eraGd2gc(ERFA_WGS84, radians(observer.longitudeDeg), radians(observer.latitudeDeg), observer.altitudeM,
           site);

  const double sinLat = std::sin(radians(observer.latitudeDeg)),
               cosLat = std::cos(radians(observer.latitudeDeg));
  const double sinLon = std::sin(radians(observer.longitudeDeg)),
               cosLon = std::cos(radians(observer.longitudeDeg));
  const glm::dmat3 enuFromTerrestrial = glm::transpose(
      glm::dmat3(glm::dvec3(-sinLon, cosLon, 0.0), glm::dvec3(-sinLat * cosLon, -sinLat * sinLon, cosLat),
                 glm::dvec3(cosLat * cosLon, cosLat * sinLon, sinLat)));
  glm::dmat3 rotation;  // ERFA's matrices are rows of columns, glm's columns of rows
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rotation[column][row] = terrestrialFromCelestial[row][column];
  auto topocentric = [&](const glm::dvec3& gcrsM) {
    return enuFromTerrestrial * (rotation * gcrsM - toVec(site));
  };
  const glm::dvec3 sunM = topocentric(sunGcrsM), moonM = topocentric(moonGcrsM);

  Ephemeris e;
  e.enuFromCelestial = enuFromTerrestrial * rotation;
  e.sun = bodyAt(sunM, kSunRadiusM);
  e.moon = bodyAt(moonM, kMoonRadiusM);
  const auto places = planetPlaces(tt.day, tt.fraction, earthAu);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PlanetPlace& p = places[i];
    e.planets[i] = {p.name, bodyAt(topocentric(apparentM(p.fromEarthAu)), p.radiusM), p.magnitude, p.colour};
  }
  const double cosPhase = glm::dot(glm::normalize(-moonM), glm::normalize(sunM - moonM));
  e.moonPhaseAngleRad = std::acos(std::clamp(cosPhase, -1.0, 1.0));
  e.moonIlluminatedFraction = 0.5 * (1.0 + cosPhase);
  const double sunAu = e.sun.distanceM / ERFA_DAU, moonRatio = kMoonMeanDistanceM / e.moon.distanceM;
  e.solarEclipse = solarEclipse(sunM, moonM);
  e.lunarEclipse = lunarEclipse(e.enuFromCelestial * sunGcrsM, e.enuFromCelestial * moonGcrsM);
  e.sunIlluminanceLux =
      kSunIlluminanceLux / (sunAu * sunAu) * static_cast<double>(e.solarEclipse.shadow.share);
  e.moonIlluminanceLux = kFullMoonIlluminanceLux * moonRatio * moonRatio / (sunAu * sunAu) *
                         std::pow(10.0, -0.4 * moonPhaseMagnitudes(e.moonPhaseAngleRad));
  if (e.lunarEclipse.any()) {
    const glm::vec3 left = moonlightColour() * e.lunarEclipse.share;
    e.moonIlluminanceLux *= static_cast<double>(luminanceOf(&left.x));
  }
  return e;
}

double darknessElevationDeg(const Ephemeris& e) {
  // From a hundredth of the sun on the sky darkens to about that of a sun 6 degrees down.
  constexpr double kDark = -6.0, kFirst = -2.0, kLast = -4.0;
  const double tens = std::log10(static_cast<double>(e.solarEclipse.shadow.share)),
               x = std::clamp((tens - kFirst) / (kLast - kFirst), 0.0, 1.0);
  return e.sun.elevationDeg + std::min(kDark - e.sun.elevationDeg, 0.0) * x * x * (3.0 - 2.0 * x);
}

}  // namespace welkin::sky
