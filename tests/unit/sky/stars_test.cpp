// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

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

// The number in the catalogue of the star nearest to a place in degrees, J2000.
std::size_t starAt(double rightAscensionDeg, double declinationDeg) {
  const auto catalogue = starCatalogue();
  const auto distance = [&](const CatalogueStar& s) {
    return std::hypot((1e-4 * s.rightAscension - rightAscensionDeg) * std::cos(radians(declinationDeg)),
                      1e-4 * s.declination - declinationDeg);
  };
  return static_cast<std::size_t>(std::ranges::min_element(catalogue, {}, distance) - catalogue.begin());
}
const std::size_t kSirius = starAt(101.287, -16.716), kVega = starAt(279.235, 38.784),
                  kPolaris = starAt(37.955, 89.264), kBetelgeuse = starAt(88.793, 7.407),
                  kRigel = starAt(78.634, -8.202), kArcturus = starAt(213.915, 19.182);

TEST(Stars, CatalogueHoldsTheBrightOnes) {
  const auto stars = starCatalogue();
  EXPECT_EQ(stars.size(), 8874u);
  EXPECT_TRUE(std::ranges::is_sorted(stars, {}, &CatalogueStar::magnitude));
  EXPECT_LE(stars.back().magnitude, 650);
  EXPECT_EQ(kSirius, 0u);
  EXPECT_NEAR(stars[kSirius].magnitude, -146, 3);  // Bright Star Catalogue
  EXPECT_NEAR(stars[kVega].magnitude, 3, 1);
  EXPECT_NEAR(stars[kPolaris].magnitude, 200, 5);
  EXPECT_EQ(std::ranges::count_if(stars, [](const CatalogueStar& s) { return s.magnitude < 150; }), 22);
}

// Azimuth and elevation without refraction by astropy 8.0.2 (ICRS to AltAz, pressure 0), from the catalogue's
// place and motion. (Of 1950 the two have UT1 a second apart.)
TEST(Stars, StandWhereAstropyHasThem) {
  struct Case {
    std::size_t star;
    const char* time;
    Observer observer;
    double azimuthDeg, elevationDeg;
  };
  for (const Case& c : {Case{kSirius, "2026-01-10T22:00:00Z", {47, 8, 500}, 166.0797, 25.1596},
                        Case{kBetelgeuse, "2026-01-10T22:00:00Z", {47, 8, 500}, 178.8870, 50.4067},
                        Case{kPolaris, "2026-01-10T22:00:00Z", {47, 8, 500}, 359.3874, 47.4613},
                        Case{kVega, "2026-07-15T23:30:00Z", {47, 8, 500}, 238.3077, 76.4146},
                        Case{kArcturus, "2026-07-15T11:30:00Z", {-33.9, 151.2, 20}, 315.6687, 23.1739},
                        Case{kArcturus, "1950-05-01T21:00:00Z", {52, 0, 20}, 121.9713, 45.4432}}) {
    const UtcTime time = parseUtcTime(c.time);
    const glm::dvec3 enu = ephemeris(time, c.observer).enuFromCelestial * starLights(time)[c.star].direction;
    const double az = radians(c.azimuthDeg), el = radians(c.elevationDeg);
    const glm::dvec3 expected(std::sin(az) * std::cos(el), std::cos(az) * std::cos(el), std::sin(el));
    EXPECT_LT(degrees(glm::length(enu - expected)), 0.004) << c.time << " " << c.azimuthDeg;
    EXPECT_NEAR(glm::length(enu), 1.0, 1e-12);
  }
}

// Through the meridian a star goes at 90 degrees less the difference of latitude and declination (of date:
// 38.807 degrees).
TEST(Stars, VegaCulminatesWhereItShould) {
  const glm::dvec3 vega = starLights(parseUtcTime("2026-07-15T12:00:00Z"))[kVega].direction;
  double highest = -90.0;
  for (int minute = 0; minute < 24 * 60; ++minute) {
    const UtcTime time = addSeconds(parseUtcTime("2026-07-15T12:00:00Z"), 60.0 * minute);
    const glm::dvec3 enu = ephemeris(time, {47, 8, 0}).enuFromCelestial * vega;
    highest = std::max(highest, degrees(std::asin(enu.z)));
  }
  EXPECT_NEAR(highest, 90.0 - (47.0 - 38.807), 0.01);
}

TEST(Stars, MagnitudesAreIlluminances) {
  EXPECT_NEAR(starIlluminanceLux(0.0), 2.54e-6, 1e-12);
  EXPECT_NEAR(starIlluminanceLux(1.0) / starIlluminanceLux(6.0), 100.0, 1e-9);
  const auto lights = starLights(parseUtcTime("2026-01-10T22:00:00Z"));
  EXPECT_NEAR(
      glm::dot(lights[kVega].illuminance, glm::vec3(0.2126f, 0.7152f, 0.0722f)) / starIlluminanceLux(0.03),
      1.0, 1e-4);
}

TEST(Stars, ColoursGoFromRedToBlue) {
  EXPECT_NEAR(starTemperatureK(0.65), 5770.0, 100.0);  // the sun
  const auto lights = starLights(parseUtcTime("2026-01-10T22:00:00Z"));
  const auto redness = [&](std::size_t i) { return lights[i].illuminance.x / lights[i].illuminance.z; };
  EXPECT_GT(redness(kBetelgeuse), 2.0f);
  EXPECT_LT(redness(kRigel), 0.85f);
  EXPECT_GT(redness(kArcturus), redness(kVega));
  const glm::vec3 white = blackBodyColour(6504.0);  // D65 is a little greener
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1.0f, 0.05f);
}

// Every cell that a spot touches must know of it: no star is cut at a cell's edge. All of the sphere about a
// star is looked at, at the size of pixel that a level is made for.
TEST(StarCells, GiveEachStarItsLightAtEverySizeOfPixel) {
  const auto all = starLights(parseUtcTime("2026-01-10T22:00:00Z"));
  for (int level = 0; level < kStarLevels; ++level) {
    const float pixelRad = 0.002f * static_cast<float>(1 << level) * 0.999f;
    EXPECT_EQ(starLevel(pixelRad), level);
    for (std::size_t i = 0; i < all.size(); i += 53) {
      const StarLight& star = all[i];
      const StarCells cells = starCells({&star, 1}, level);
      const shared::sampler2D texels{&cells.texels};
      const glm::dvec3 side = glm::normalize(glm::cross(star.direction, std::abs(star.direction.z) < 0.9
                                                                            ? glm::dvec3(0, 0, 1)
                                                                            : glm::dvec3(1, 0, 0))),
                       up = glm::cross(star.direction, side);
      // Equal-area rings about the star: chord^2 / 4 is uniform.
      constexpr int kRings = 400, kAround = 8;
      const double reach = std::min(6.0 * pixelRad, 1.9);
      double sum = 0.0;
      for (int r = 0; r < kRings; ++r)
        for (int a = 0; a < kAround; ++a) {
          const double chord2 = reach * reach * (r + 0.5) / kRings, cosine = 1.0 - 0.5 * chord2,
                       sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0)), phi = 2.0 * kPi * a / kAround;
          const glm::vec3 dir(cosine * star.direction + sine * (std::cos(phi) * side + std::sin(phi) * up));
          const glm::vec3 l = shared::starLuminance(texels, cells.cells, dir, pixelRad);
          sum += l.y * kPi * reach * reach / (kRings * kAround);
        }
      EXPECT_NEAR(sum / star.illuminance.y, 1.0, 0.05) << level << ", star " << i;
    }
  }
}

TEST(StarCells, StarsComeOutWhenTheSunIsDown) {
  EXPECT_EQ(starlightShare(3.0), 0.0f);
  EXPECT_EQ(starlightShare(0.0), 1.0f);
  EXPECT_EQ(starlightShare(-20.0), 1.0f);
  EXPECT_GT(starlightShare(1.0), starlightShare(2.0));
}

}  // namespace
}  // namespace welkin::sky
