// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/eclipse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "welkin/core/colour.h"
#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/ephemeris.h"
#include "welkin/sky/light.h"

namespace welkin::sky {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/eclipse.glsl"
}  // namespace shared

constexpr Observer kLeon{42.5987, -5.5671, 840.0};

Ephemeris at(const std::string& time, const Observer& observer, double secondsAfter = 0.0) {
  return ephemeris(addSeconds(parseUtcTime(time), secondsAfter), observer);
}

double limb(double x2) {
  return x2 < 1.0 ? std::pow(1.0 - x2, 0.205) * 1.205 : 0.0;
}

// The share that passes by, summed over a fine grid of the sun's disc.
double pastByGrid(double middle, double radius) {
  constexpr int kSide = 1500;
  double seen = 0.0, all = 0.0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double x = 2.0 * (i + 0.5) / kSide - 1.0, y = 2.0 * (j + 0.5) / kSide - 1.0;
      const double light = limb(x * x + y * y);
      all += light;
      if (std::hypot(x - middle, y) > radius) seen += light;
    }
  return seen / all;
}

TEST(Eclipse, LightPastADiscIsTheIntegralOfTheLimbDarkenedSun) {
  for (const double radius : {0.95, 1.0, 1.035, 3.7})
    for (const double of : {0.0, 0.01, 0.06, 0.3, 0.5, 0.8, 0.97, 1.1}) {
      const double middle = std::max(radius - 1.0, 0.0) * (1.0 - of) + (1.0 + radius) * of;
      EXPECT_NEAR(shared::sunPast(static_cast<float>(middle), static_cast<float>(radius)),
                  pastByGrid(middle, radius), 5e-4)
          << middle << ", " << radius;
    }
  EXPECT_EQ(shared::sunPast(2.04f, 1.035f), 1.0f);
  EXPECT_EQ(shared::sunPast(0.03f, 1.035f), 0.0f);
}

TEST(Eclipse, CoronaHoldsTheLightOfItsLaw) {
  double sum = 0.0;
  constexpr double kStep = 1e-3;
  for (double r = 1.0 + 0.5 * kStep; r < 8.0; r += kStep)
    sum += 2.0 * r * kStep * static_cast<double>(shared::coronaLuminance(static_cast<float>(r)));
  EXPECT_NEAR(sum / static_cast<double>(shared::kCoronaShare), 0.90, 0.02);  // its end takes a tenth
}

// Second and third contact with the JPL ephemeris DE421 and the radii of welkin/sky/eclipse.h, made with
// Skyfield 1.55. F. Espenak and J. Anderson's for Dallas are 18:40:43 and 18:44:35, with the moon's valleys.
TEST(Eclipse, TotalityComesWithinTwelveSeconds) {
  struct Total {
    const char *second, *third;
    Observer place;
  };
  for (const Total& t : {Total{"2026-08-12T18:28:20Z", "2026-08-12T18:30:08Z", kLeon},
                         Total{"2026-08-12T18:28:25Z", "2026-08-12T18:30:12Z", {42.3409, -3.6997, 860.0}},
                         Total{"2024-04-08T18:40:41Z", "2024-04-08T18:44:37Z", {32.7767, -96.7970, 130.0}},
                         Total{"2017-08-21T18:24:09Z", "2017-08-21T18:26:53Z", {36.9664, -87.6711, 150.0}},
                         Total{"1999-08-11T10:32:54Z", "1999-08-11T10:35:15Z", {48.7758, 9.1829, 250.0}},
                         Total{"1999-08-11T10:37:11Z", "1999-08-11T10:39:24Z", {48.1372, 11.5755, 520.0}}}) {
    constexpr double kS = 12.0;
    EXPECT_LT(at(t.second, t.place, -kS).solarEclipse.obscuration, 1.0) << t.second;
    EXPECT_EQ(at(t.second, t.place, kS).solarEclipse.obscuration, 1.0) << t.second;
    EXPECT_EQ(at(t.third, t.place, -kS).solarEclipse.obscuration, 1.0) << t.third;
    EXPECT_LT(at(t.third, t.place, kS).solarEclipse.obscuration, 1.0) << t.third;
  }
}

// The largest obscurations that were announced, in percent.
TEST(Eclipse, PartialEclipsesHideAsMuchAsPublished) {
  struct Partial {
    const char* from;
    Observer place;
    double percent;
  };
  for (const Partial& p : {Partial{"2017-08-21T17:00:00Z", {34.0522, -118.2437, 90.0}, 62.1},   // Los Angeles
                           Partial{"2017-08-21T18:25:00Z", {40.7128, -74.0060, 10.0}, 71.5},    // New York
                           Partial{"2024-04-08T19:05:00Z", {40.7128, -74.0060, 10.0}, 89.6},    // New York
                           Partial{"2024-04-08T18:47:00Z", {41.8781, -87.6298, 180.0}, 93.9},   // Chicago
                           Partial{"1999-08-11T10:00:00Z", {51.5072, -0.1276, 20.0}, 96.6}}) {  // London
    double most = 0.0;
    for (double s = 0.0; s < 2400.0; s += 20.0)
      most = std::max(most, at(p.from, p.place, s).solarEclipse.obscuration);
    EXPECT_NEAR(100.0 * most, p.percent, 0.6) << p.from;
  }
}

// F. Espenak and J. Meeus 2009, "Five Millennium Canon of Lunar Eclipses", by Danjon's rule, at greatest
// eclipse.
TEST(Eclipse, LunarMagnitudesAreThePublishedOnes) {
  struct Lunar {
    const char* time;
    double umbral, penumbral;
  };
  for (const Lunar& l :
       {Lunar{"2025-03-14T06:58:43Z", 1.1784, 2.2595}, Lunar{"2022-05-16T04:11:28Z", 1.4137, 2.3726},
        Lunar{"2018-07-27T20:21:44Z", 1.6087, 2.6792}, Lunar{"2021-11-19T09:02:53Z", 0.9742, 2.0720},
        Lunar{"2023-10-28T20:14:05Z", 0.1220, 1.1181}}) {
    const LunarEclipse e = at(l.time, {40.0, -100.0, 0.0}).lunarEclipse;
    EXPECT_NEAR(e.umbralMagnitude, l.umbral, 0.008) << l.time;
    EXPECT_NEAR(e.penumbralMagnitude, l.penumbral, 0.015) << l.time;
  }
  // First and last contact of umbra and moon.
  for (const char* time : {"2025-03-14T05:09:33Z", "2025-03-14T08:47:52Z"}) {
    EXPECT_NEAR(at(time, {}).lunarEclipse.umbralMagnitude, 0.0, 0.01) << time;
    EXPECT_GT(at(time, {}).lunarEclipse.penumbralMagnitude, 1.0) << time;
  }
}

TEST(Eclipse, LightGoesAndComesWithoutSteps) {
  double before = 1.0;
  for (double s = 0.0; s < 7200.0; s += 4.0) {
    const Ephemeris e = at("2026-08-12T17:30:00Z", kLeon, s);
    const auto share = static_cast<double>(e.solarEclipse.shadow.share);
    EXPECT_NEAR(share, before, 2.5e-3) << s;
    EXPECT_GT(share, 1e-6);
    before = share;
  }
  EXPECT_EQ(before, 1.0);
  EXPECT_EQ(shared::sunHidden(at("2026-08-12T18:29:04Z", kLeon).solarEclipse.shadow.share), 1.0f);
  before = 1.0;
  for (double s = 0.0; s < 23000.0; s += 20.0) {
    const LunarEclipse e = at("2025-03-14T03:50:00Z", {}, s).lunarEclipse;
    EXPECT_NEAR(e.share.y, before, 1e-2) << s;
    EXPECT_GT(e.share.z, 1e-9f);
    before = static_cast<double>(e.share.y);
  }
  EXPECT_EQ(before, 1.0);
}

// Between the eclipses of 2025-09-21 and of 2026-02-17.
TEST(Eclipse, NothingIsEclipsedOnOrdinaryDays) {
  for (double day = 0.0; day < 125.0; day += 0.037) {
    const Ephemeris e = at("2025-10-05T00:00:00Z", {47.0, 8.0, 400.0}, 86400.0 * day);
    ASSERT_FALSE(e.solarEclipse.shadow.any()) << day;
    ASSERT_FALSE(e.lunarEclipse.any()) << day;
    EXPECT_EQ(e.solarEclipse.obscuration, 0.0);
    EXPECT_EQ(shared::sunHidden(e.solarEclipse.shadow.share), 0.0f);
    EXPECT_EQ(e.lunarEclipse.share, glm::vec3(1.0f));
    EXPECT_EQ(sunLight(e).illuminance, static_cast<float>(e.sunIlluminanceLux) * sunlightColour());
    EXPECT_EQ(sunLight(e).fullIlluminance(), sunLight(e).illuminance);
    EXPECT_EQ(moonLight(e).illuminance, static_cast<float>(e.moonIlluminanceLux) * moonlightColour());
    EXPECT_EQ(darknessElevationDeg(e), e.sun.elevationDeg);
  }
}

TEST(Eclipse, TheEclipsedMoonIsCopper) {
  const Ephemeris e = at("2025-03-14T06:58:43Z", {40.0, -100.0, 0.0});
  const glm::vec3 left = e.lunarEclipse.share, light = moonLight(e).illuminance, full = fullMoonlight(e);
  EXPECT_GT(left.x, 2.0f * left.y);
  EXPECT_GT(left.y, 2.0f * left.z);
  const float dimmed = luminanceOf(&light.x) / luminanceOf(&full.x);
  EXPECT_GT(dimmed, 1e-5f);
  EXPECT_LT(dimmed, 3e-4f);
  EXPECT_NEAR(luminanceOf(&light.x) / e.moonIlluminanceLux, 1.0, 1e-3);
  // Darker and redder towards the axis of the shadow, and sunlit far out.
  const glm::vec3 inner = shared::sunOnMoon(0.0f, 3.7f), outer = shared::sunOnMoon(2.4f, 3.7f);
  EXPECT_LT(inner.y, outer.y);
  EXPECT_GT(inner.x / inner.y, outer.x / outer.y);
  EXPECT_EQ(shared::sunOnMoon(4.8f, 3.7f), glm::vec3(1.0f));
}

// The image of the sun in the earth's air that shaders/lib/eclipse.glsl is fitted to.
glm::dvec3 refractedLight(double middleRad) {
  constexpr double kEarthM = 6371e3, kMoonM = 384.4e6, kScaleM = 8400.0, kDegree = kPi / 180.0;
  const double sun = 16.0 / 60.0 * kDegree, mostTurned = 70.0 / 60.0 * kDegree;
  const AtmosphereUniforms air = atmosphereUniforms({}, 60e3, 0.0, glm::vec3(0.2f));
  glm::dvec3 sum(0.0);
  constexpr double kStepM = 200.0;
  for (double h = 0.5 * kStepM; h < 70e3; h += kStepM) {
    // Along a ray whose lowest point is at h.
    double ozoneM = 0.0;
    const double half = std::sqrt(2.0 * kEarthM * std::max(40e3 - h, 0.0));
    for (int i = 0; i < 100; ++i) {
      const double x = half * (i + 0.5) / 100.0, z = h + x * x / (2.0 * kEarthM);
      ozoneM +=
          std::max(1.0 - std::abs(z - static_cast<double>(air.ozoneAltitudeM)) / 15e3, 0.0) * half / 50.0;
    }
    const double airM = std::sqrt(2.0 * kPi * kEarthM * kScaleM) * std::exp(-h / kScaleM);
    const glm::dvec3 through =
        glm::exp(-glm::dvec3(air.rayleighScattering) * airM - glm::dvec3(air.ozoneAbsorption) * ozoneM) *
        std::min(0.2 + 0.8 * h / 12e3, 1.0);
    const double seen = (kEarthM + h) / kMoonM, from = seen - mostTurned * std::exp(-h / kScaleM);
    double light = 0.0;
    constexpr int kAround = 180;
    for (int i = 0; i < kAround; ++i) {
      const double a = kPi * (i + 0.5) / kAround;
      light +=
          limb((std::pow(from * std::cos(a) - middleRad, 2) + std::pow(from * std::sin(a), 2)) / (sun * sun));
    }
    sum += through * (light * 2.0 * kPi / kAround * seen * kStepM / kMoonM / (kPi * sun * sun));
  }
  return sum;
}

TEST(Eclipse, UmbralLightIsThatOfTheImageInTheAir) {
  const double sun = radians(16.0 / 60.0), earth = 1.01 * 6371e3 / 384.4e6;
  for (double u = 0.0; u < 0.97; u += 0.1) {
    const glm::dvec3 exact = refractedLight(u * (earth - sun));
    const glm::vec3 drawn =
        shared::sunOnMoon(static_cast<float>(u * (earth - sun) / sun), static_cast<float>(earth / sun));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(std::log10(static_cast<double>(drawn[c])), std::log10(exact[c]), 0.22) << u << ", " << c;
  }
}

// C. Emde and B. Mayer 2007, "Simulation of solar radiation during a total eclipse: a challenge for radiative
// transfer": radiance and irradiance fall by 3 to 4 orders of magnitude.
TEST(Eclipse, TheSkyInTotalityIsLitFromOutsideTheUmbra) {
  const Atmosphere air({}, 60e3, 840.0, glm::vec3(0.2f));
  const Light total = sunLight(at("2026-08-12T18:29:04Z", kLeon));
  Light clear = total;
  clear.illuminance = total.fullIlluminance();
  clear.shadow = {};
  const auto illuminance = [&](const Light& light) {
    const glm::vec3 e = air.skyIlluminance(840.0, {&light, 1});
    return luminanceOf(&e.x);
  };
  const float share = illuminance(total) / illuminance(clear);
  EXPECT_GT(share, 1e-4f);
  EXPECT_LT(share, 2e-3f);
  // Brighter and redder all around the horizon than overhead.
  const glm::vec3 zenith = air.skyLuminance(840.0, {0, 0, 1}, {&total, 1});
  for (int i = 0; i < 8; ++i) {
    const double a = 2.0 * kPi * i / 8.0;
    const glm::vec3 low = air.skyLuminance(
        840.0, glm::normalize(glm::vec3(glm::dvec3(std::cos(a), std::sin(a), 0.03))), {&total, 1});
    EXPECT_GT(luminanceOf(&low.x), 3.0f * luminanceOf(&zenith.x)) << i;
    EXPECT_GT(low.x / low.z, zenith.x / zenith.z) << i;
  }
  // Where the shadow has not come, the sun shines.
  EXPECT_GT(sunShareAt(total.shadow, total.direction, {0.0f, 300e3f, 0.0f}), 0.01f);
  EXPECT_NEAR(sunShareAt(total.shadow, total.direction, glm::vec3(0.0f)), total.shadow.share, 1e-9f);
}

}  // namespace
}  // namespace welkin::sky
