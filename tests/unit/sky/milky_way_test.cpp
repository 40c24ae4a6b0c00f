// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/milky_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/sky/stars.h"

namespace welkin::sky {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/milky_way.glsl"
}  // namespace shared

constexpr double kPoleS10 = 28.0;

const glm::dmat3 kCelestialFromGalactic(shared::kGalaxyCentre, shared::kGalaxyAhead, shared::kGalaxyPole);

double s10At(double longitudeDeg, double latitudeDeg) {
  const double l = radians(longitudeDeg), b = radians(latitudeDeg);
  const glm::vec3 way(kCelestialFromGalactic *
                      glm::dvec3(std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b)));
  const shared::sampler2D map{&milkyWay(), shared::Wrap::kRepeat, shared::Wrap::kClamp};
  const glm::vec3 luminance(shared::textureLod(map, shared::milkyWayAt(way), 0.0f));
  return glm::dot(luminance, glm::vec3(0.2126f, 0.7152f, 0.0722f)) / 8.34e-7;
}
// With the light that is everywhere, which the map leaves out.
double meanS10(double fromLatitudeDeg, double toLatitudeDeg) {
  double sum = 0.0, weight = 0.0;
  for (double b = fromLatitudeDeg + 0.25; b < toLatitudeDeg; b += 0.5)
    for (double l = 0.0; l < 360.0; l += 1.0)
      for (const double side : {-1.0, 1.0}) {
        sum += (kPoleS10 + s10At(l, side * b)) * std::cos(radians(b));
        weight += std::cos(radians(b));
      }
  return sum / weight;
}

// C. Leinert et al. 1998, "The 1997 reference of diffuse night sky brightness", has starlight of some 25 S10
// at the poles and 100 to 400 in the plane.
TEST(MilkyWay, IsAsBrightAsMeasured) {
  EXPECT_NEAR(meanS10(0.0, 5.0), 170.0, 40.0);
  EXPECT_NEAR(meanS10(19.0, 21.0), 75.0, 20.0);
  EXPECT_NEAR(meanS10(29.0, 31.0), 50.0, 15.0);
  double most = 0.0, mostL = 0.0, mostB = 0.0;
  for (double l = 0.0; l < 360.0; l += 0.5)
    for (double b = -30.0; b <= 30.0; b += 0.5)
      if (const double s = s10At(l, b); s > most) most = s, mostL = l, mostB = b;
  EXPECT_GT(most, 250.0);
  EXPECT_LT(most, 450.0);
  EXPECT_LT(std::abs(std::remainder(mostL, 360.0)), 10.0) << mostL;  // Sagittarius, south of the plane
  EXPECT_LT(mostB, 0.0);
  EXPECT_GT(mostB, -8.0);
}

TEST(MilkyWay, HasItsCloudsAndItsRift) {
  const double cygnus = s10At(73, 2), carina = s10At(288, -1), anticentre = s10At(180, 2);
  EXPECT_GT(cygnus, 1.7 * anticentre);
  EXPECT_GT(carina, 1.7 * anticentre);
  EXPECT_LT(s10At(30, 4), 0.6 * cygnus);         // the rift in Aquila
  EXPECT_LT(s10At(15, 8), 0.6 * s10At(15, -8));  // and in Ophiuchus
  EXPECT_LT(s10At(302.5, -0.5), 0.6 * carina);   // the Coalsack
  EXPECT_LT(s10At(172, -13), 0.5 * anticentre);  // the dark clouds of Taurus
}

TEST(MilkyWay, HasNoSeamsAndEndsSoftly) {
  EXPECT_NEAR(s10At(359.999, 3.0), s10At(0.001, 3.0), 0.1);
  EXPECT_NEAR(s10At(179.999, 3.0), s10At(180.001, 3.0), 0.1);
  for (const double b : {-90.0, -60.0, -48.0, 48.0, 70.0, 90.0})
    for (double l = 0.0; l < 360.0; l += 7.0) EXPECT_LT(s10At(l, b), 1.0);
}

// J2000: the centre near 17h45.6m, -28.94 degrees; the north pole at 12h51.4m, 27.13 degrees.
TEST(MilkyWay, LiesWhereTheGalaxyDoes) {
  const auto celestial = [](double raDeg, double decDeg) {
    const double a = radians(raDeg), d = radians(decDeg);
    return glm::dvec3(std::cos(d) * std::cos(a), std::cos(d) * std::sin(a), std::sin(d));
  };
  const glm::dmat3 toGalactic = glm::transpose(kCelestialFromGalactic);
  EXPECT_LT(glm::length(toGalactic * celestial(266.405, -28.936) - glm::dvec3(1, 0, 0)), 2e-4);
  EXPECT_LT(glm::length(toGalactic * celestial(192.859, 27.128) - glm::dvec3(0, 0, 1)), 2e-4);
  // Deneb, in the Milky Way: l = 84.28, b = 2.00.
  const glm::dvec3 deneb = toGalactic * celestial(310.358, 45.280);
  EXPECT_NEAR(degrees(std::atan2(deneb.y, deneb.x)), 84.28, 0.02);
  EXPECT_NEAR(degrees(std::asin(deneb.z)), 2.0, 0.02);
  EXPECT_NEAR(glm::determinant(toGalactic), 1.0, 1e-6);
}

TEST(MilkyWay, IsWarmAndOfTheNight) {
  const Image<float>& map = milkyWay();
  const float* inPlane = &map.data[map.index(0, map.height / 2)];
  EXPECT_GT(inPlane[0], inPlane[1]);
  EXPECT_GT(inPlane[1], inPlane[2]);
  EXPECT_EQ(milkyWayShare(-6.0), 0.0f);
  EXPECT_EQ(milkyWayShare(-10.0), 1.0f);
}

}  // namespace
}  // namespace welkin::sky
