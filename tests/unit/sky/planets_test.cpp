// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/planets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <sstream>
#include <string>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/sky/ephemeris.h"
#include "welkin/sky/star_cells.h"

namespace welkin::sky {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/stars.glsl"
}  // namespace shared

constexpr Observer kEarthsCentre{0.0, 0.0, -6378137.0};

double separationDeg(const glm::dvec3& a, const glm::dvec3& b) {
  return degrees(2.0 * std::asin(0.5 * glm::length(a - b)));
}

const Planet& planetOf(const Ephemeris& e, std::string_view name) {
  return *std::ranges::find(e.planets, name, &Planet::name);
}

// At random moments of 1900 to 2050 against a JPL ephemeris (tests/data/sky/README.md).
TEST(Planets, AgreeWithJplEphemeris) {
  std::ifstream file(WELKIN_TEST_DATA_DIR "/sky/planets.tsv");
  ASSERT_TRUE(file);
  int rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream in(line);
    std::string time;
    in >> time;
    const Ephemeris e = ephemeris(parseUtcTime(time), kEarthsCentre);
    for (const Planet& planet : e.planets) {
      double raDeg = 0.0, decDeg = 0.0, v = 0.0;
      in >> raDeg >> decDeg >> v;
      ASSERT_TRUE(in) << line;
      const double ra = radians(raDeg), dec = radians(decDeg);
      const glm::dvec3 expected(std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec));
      const double apart =
          separationDeg(glm::transpose(e.enuFromCelestial) * planet.body.direction, expected);
      EXPECT_LT(apart, 0.025) << planet.name << " " << time;  // 1.5 arc minutes
      EXPECT_NEAR(planet.magnitude, v, 0.02) << planet.name << " " << time;
    }
    ++rows;
  }
  EXPECT_EQ(rows, 60);
}

// As observed: conjunction at 6.1 arc minutes; the transit's smallest distance from the sun's middle, 554 arc
// seconds; oppositions and greatest brilliancy as the almanacs have them.
TEST(Planets, StandInKnownSights) {
  const Ephemeris conjunction = ephemeris(parseUtcTime("2020-12-21T18:20:00Z"), kEarthsCentre);
  EXPECT_NEAR(separationDeg(planetOf(conjunction, "jupiter").body.direction,
                            planetOf(conjunction, "saturn").body.direction),
              6.1 / 60.0, 0.02);
  const Ephemeris transit = ephemeris(parseUtcTime("2012-06-06T01:29:36Z"), kEarthsCentre);
  EXPECT_NEAR(separationDeg(planetOf(transit, "venus").body.direction, transit.sun.direction), 554.0 / 3600.0,
              0.01);
  EXPECT_NEAR(degrees(planetOf(transit, "venus").body.angularRadiusRad), 28.9 / 3600.0, 1e-4);
  const auto magnitude = [](const char* name, const char* time) {
    return planetOf(ephemeris(parseUtcTime(time), kEarthsCentre), name).magnitude;
  };
  EXPECT_NEAR(magnitude("mars", "2003-08-28T18:00:00Z"), -2.9, 0.1);
  EXPECT_NEAR(magnitude("jupiter", "2022-09-26T20:00:00Z"), -2.9, 0.1);
  EXPECT_NEAR(magnitude("venus", "2025-02-14T20:00:00Z"), -4.9, 0.1);
  // Rings wide open, and from their edge.
  EXPECT_NEAR(magnitude("saturn", "2003-12-31T21:00:00Z"), -0.5, 0.1);
  EXPECT_NEAR(magnitude("saturn", "2025-09-21T06:00:00Z"), 0.6, 0.15);
}

TEST(Planets, StandNearTheEclipticToTheEndOfTheCentury) {
  for (const char* time : {"1900-01-01T00:00:00Z", "2075-05-05T05:00:00Z", "2100-12-31T23:59:59Z"}) {
    const Ephemeris e = ephemeris(parseUtcTime(time), {47.0, 8.0, 0.0});
    const glm::dvec3 pole(0.0, -std::sin(radians(23.439)), std::cos(radians(23.439)));
    for (const Planet& planet : e.planets) {
      const glm::dvec3 celestial = glm::transpose(e.enuFromCelestial) * planet.body.direction;
      EXPECT_LT(std::abs(90.0 - degrees(std::acos(glm::dot(celestial, pole)))), 9.0) << planet.name;
      EXPECT_TRUE(planet.magnitude > -5.0 && planet.magnitude < 6.5) << planet.name << planet.magnitude;
    }
    EXPECT_LT(separationDeg(planetOf(e, "mercury").body.direction, e.sun.direction), 29.0);
    EXPECT_LT(separationDeg(planetOf(e, "venus").body.direction, e.sun.direction), 48.5);
  }
}

// Light comes back whatever the pixels: smaller than a disc, and far larger.
TEST(PlanetSpots, HoldTheirLight) {
  for (const float pixelRad : {1e-5f, 1e-4f, 1e-3f, 1e-2f})
    for (const float brighter : {-1.0f, 0.5f, 9.0f}) {
      constexpr float kLeastRad = 3e-4f;
      const double reach = std::max(8.0 * pixelRad, 1.01 * static_cast<double>(kLeastRad));
      double sum = 0.0;
      constexpr int kRings = 2000;
      for (int i = 0; i < kRings; ++i) {
        const double r = reach * std::sqrt((i + 0.5) / kRings);
        const glm::vec3 away(static_cast<float>(r), 0.0f, 0.0f);
        sum += shared::planetShare(away, brighter, kLeastRad, pixelRad) * kPi * reach * reach / kRings;
      }
      EXPECT_NEAR(sum, 1.0, 0.01) << pixelRad << " " << brighter;
    }
  // And is no brighter than the disc: of 1 lux from radius a, 1 / (pi a^2).
  EXPECT_NEAR(shared::planetShare(glm::vec3(0.0f), 9.0f, 2e-4f, 1e-6f) * kPi * 1e-8, 1.0, 0.01);
}

TEST(PlanetSpots, AreThoseThatMayBeSeen) {
  Ephemeris e = ephemeris(parseUtcTime("2026-06-21T20:00:00Z"), {47.0, 8.0, 0.0});
  const auto count = [&](double eyeM, float pixelRad = 1.5e-4f) {
    return planetSpots(e, eyeM, pixelRad).count;
  };
  for (Planet& planet : e.planets) planet.body.direction = glm::dvec3(0, 0, 1);
  e.sun.elevationDeg = -5.0;
  EXPECT_EQ(count(0.0), kPlanetCount);
  e.sun.elevationDeg = 40.0;
  EXPECT_EQ(count(0.0, 3e-3f), 0);
  EXPECT_EQ(count(0.0, 5e-4f), 1);
  EXPECT_EQ(count(0.0), 2);  // Venus and Jupiter, V = -4.0 and -1.8
  const PlanetSpots day = planetSpots(e, 0.0, 1.5e-4f);
  EXPECT_NEAR(glm::dot(day.spots[0].illuminance, glm::vec3(0.2126f, 0.7152f, 0.0722f)) /
                  starIlluminanceLux(planetOf(e, "venus").magnitude),
              1.0, 1e-4);
  for (Planet& planet : e.planets) planet.body.direction = glm::normalize(glm::dvec3(0, 1, -0.15));
  EXPECT_EQ(count(0.0), 0);
  EXPECT_EQ(count(40e3), 2);  // from there the horizon is 6.4 degrees lower
}

}  // namespace
}  // namespace welkin::sky
