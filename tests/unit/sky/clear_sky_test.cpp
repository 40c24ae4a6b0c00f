// SPDX-License-Identifier: Apache-2.0
// The clear sky against other people's numbers. "Clear" is the default atmosphere with a visibility of 40 km
// over ground of albedo 0.2.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec2.hpp>

#include "welkin/core/units.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::sky {
namespace {

const Atmosphere& clearAir() {
  static const Atmosphere air(AtmosphereParams{}, 40e3, 0.0, glm::vec3(0.2f));
  return air;
}
double luminance(const glm::vec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

glm::vec3 directionAt(double elevationDeg, double azimuthDeg) {
  const double e = radians(elevationDeg), a = radians(azimuthDeg);
  return glm::vec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
}
std::vector<Light> sunAt(double elevationDeg) {
  return {{directionAt(elevationDeg, 0.0), 133100.0f * sunlightColour()}};
}

// CIE 1931 x, y of a linear Rec. 709 colour.
glm::dvec2 chromaticity(const glm::vec3& c) {
  const double x = 0.4124 * c.x + 0.3576 * c.y + 0.1805 * c.z, y = luminance(c),
               z = 0.0193 * c.x + 0.1192 * c.y + 0.9505 * c.z;
  return {x / (x + y + z), y / (x + y + z)};
}

double horizontalIlluminance(const std::vector<Light>& lights) {
  double sum = luminance(clearAir().skyIlluminance(0.0, lights));
  for (const Light& l : lights) {
    sum += luminance(l.illuminance * clearAir().transmittanceToSpace(0.0, l.direction.z)) *
           std::max(l.direction.z, 0.0f);
  }
  return sum;
}

struct Row {
  double elevationDeg;
  double value;
};

// Horizontal illuminance under a clear sky, lux: the polynomials of P. M. Janiczek and J. A. DeYoung 1987,
// "Computer Programs for Sun and Moon Illuminance with Contingent Tables and Diagrams", US Naval Observatory
// Circular 171. Between the rows of the circular's table they lie up to 12 % (by day) and 45 % (in twilight)
// above a line through logarithms.
double circularIlluminance(double elevationDeg) {
  struct Piece {
    double fromDeg, c[4];  // log10 lux by powers of elevation / 90 degrees
  };
  constexpr Piece kPieces[] = {{20, {3.74, 3.97, -4.07, 1.47}},
                               {5, {3.05, 13.28, -45.98, 64.33}},
                               {-0.8, {2.88, 22.26, -207.64, 1034.30}},
                               {-5, {2.88, 21.81, -258.11, -858.36}},
                               {-12, {2.70, 12.17, -431.69, -1899.83}}};
  const double x = elevationDeg / 90.0;
  for (const Piece& p : kPieces)
    if (elevationDeg >= p.fromDeg) return std::pow(10.0, p.c[0] + x * (p.c[1] + x * (p.c[2] + x * p.c[3])));
  return 0.0;
}

TEST(ClearSky, TheCircularsPolynomialsGiveItsTable) {
  for (const Row& row : {Row{-6, 3.4}, Row{0, 759}, Row{5, 4540}, Row{10, 11100}, Row{20, 27400},
                         Row{30, 46300}, Row{60, 103100}, Row{90, 128800}})
    EXPECT_NEAR(circularIlluminance(row.elevationDeg) / row.value, 1.0, 0.005) << row.elevationDeg;
}

TEST(ClearSky, DaylightIlluminance) {
  for (double elevation = 2.0; elevation <= 90.0; elevation += 1.0)
    EXPECT_NEAR(horizontalIlluminance(sunAt(elevation)) / circularIlluminance(elevation), 1.0, 0.15)
        << elevation << " degrees";
}

TEST(ClearSky, TwilightIlluminance) {
  for (double elevation = -6.0; elevation < 2.0; elevation += 0.5) {
    const double ratio = horizontalIlluminance(sunAt(elevation)) / circularIlluminance(elevation);
    EXPECT_GT(ratio, 0.5) << elevation << " degrees";
    EXPECT_LT(ratio, 2.0) << elevation << " degrees";
  }
  // Night falls without a bump, down to the airglow.
  double before = horizontalIlluminance(sunAt(2.0));
  for (double elevation = 1.0; elevation >= -20.0; elevation -= 1.0) {
    const double now = horizontalIlluminance(sunAt(elevation));
    EXPECT_LE(now, before * 1.001) << elevation;
    before = now;
  }
  EXPECT_NEAR(before / 6.4e-4, 1.0, 0.3);
}

// Full moon at 60 degrees: 0.216 lux (the same circular).
TEST(ClearSky, Moonlight) {
  EXPECT_NEAR(horizontalIlluminance({{directionAt(60, 0), 0.27f * moonlightColour()}}), 0.216, 0.03);
}

// L. Hosek and A. Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance", turbidity 3, ground
// albedo 0.2.
TEST(ClearSky, ZenithLuminance) {
  for (const Row& row : {Row{5, 850}, Row{10, 1173}, Row{30, 2135}, Row{60, 3863}}) {
    const double got = luminance(clearAir().skyLuminance(0.0, {0, 0, 1}, sunAt(row.elevationDeg)));
    EXPECT_NEAR(got / row.value, 1.0, 0.30) << row.elevationDeg << " degrees";
  }
}

TEST(ClearSky, NoonIsBlueAndDeepensUpwards) {
  const std::vector<Light> sun = sunAt(30);
  const glm::vec3 zenith = clearAir().skyLuminance(0.0, {0, 0, 1}, sun);
  const glm::dvec2 xy = chromaticity(zenith);
  EXPECT_NEAR(xy.x, 0.240, 0.03);
  EXPECT_NEAR(xy.y, 0.247, 0.03);
  // Away from the sun: darker and bluer from the horizon to 60 degrees up.
  double lastBlue = 0.0, lastLuminance = 1e9;
  for (double elevation : {2.0, 10.0, 25.0, 60.0}) {
    const glm::vec3 c = clearAir().skyLuminance(0.0, directionAt(elevation, 150), sun);
    EXPECT_GT(c.z / c.x, lastBlue) << elevation;
    EXPECT_LT(luminance(c), lastLuminance) << elevation;
    lastBlue = c.z / c.x;
    lastLuminance = luminance(c);
  }
}

TEST(ClearSky, GoldenHourIsGolden) {
  const glm::vec3 glow = clearAir().skyLuminance(0.0, directionAt(2, 10), sunAt(2));
  EXPECT_GT(glow.x, 1.8f * glow.y);
  EXPECT_GT(glow.y, 2.0f * glow.z);
  const glm::vec3 direct = clearAir().transmittanceToSpace(0.0, std::sin(radians(4.0)));
  EXPECT_GT(direct.x, 1.8f * direct.y);
  EXPECT_GT(direct.y, 2.0f * direct.z);
}

// Ozone keeps the zenith blue when all light has gone a long way through the air; without it twilight is
// pale.
TEST(ClearSky, BlueHourIsBlueByOzone) {
  AtmosphereParams none;
  none.ozoneDu = 0.0;
  const Atmosphere withoutOzone(none, 40e3, 0.0, glm::vec3(0.2f));
  const glm::vec3 blue = clearAir().skyLuminance(0.0, {0, 0, 1}, sunAt(-5));
  const glm::vec3 pale = withoutOzone.skyLuminance(0.0, {0, 0, 1}, sunAt(-5));
  EXPECT_GT(blue.z, 2.0f * blue.y);
  EXPECT_GT(blue.y, 1.2f * blue.x);
  EXPECT_LT(pale.z / pale.x, 0.6f * blue.z / blue.x);
}

TEST(ClearSky, AirglowKeepsNightFromBlack) {
  const double zenith = luminance(clearAir().skyLuminance(0.0, {0, 0, 1}, {}));
  EXPECT_NEAR(zenith, 1.7e-4, 4e-5);
  EXPECT_GT(luminance(clearAir().skyLuminance(0.0, directionAt(15, 0), {})), zenith);  // van Rhijn
  EXPECT_EQ(luminance(clearAir().skyLuminance(0.0, directionAt(-15, 0), {})),
            0.0);  // not in front of the ground
}

TEST(ClearSky, LightsAdd) {
  const std::vector<Light> sun = sunAt(8), moon = {{directionAt(40, 120), 5000.0f * moonlightColour()}};
  const glm::vec3 d = directionAt(25, 60);
  const glm::vec3 both = clearAir().skyLuminance(0.0, d, std::vector{sun[0], moon[0]});
  const glm::vec3 apart = clearAir().skyLuminance(0.0, d, sun) + clearAir().skyLuminance(0.0, d, moon);
  EXPECT_NEAR(luminance(both), luminance(apart), 1e-3);
}

TEST(ClearSky, DarkensWithAltitude) {
  const std::vector<Light> sun = sunAt(40);
  double before = 1e9;
  for (double h : {0.0, 2e3, 5e3, 12e3, 20e3, 50e3}) {
    const double now = luminance(clearAir().skyLuminance(h, {0, 0, 1}, sun));
    EXPECT_LT(now, before) << h;
    before = now;
  }
  EXPECT_EQ(luminance(clearAir().skyLuminance(150e3, {0, 0, 1}, sun)), 0.0);
  EXPECT_GT(luminance(clearAir().skyLuminance(150e3, {0, 0, -1}, sun)), 100.0);  // the blue veil from above
}

}  // namespace
}  // namespace welkin::sky
