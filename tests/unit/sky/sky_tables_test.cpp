// SPDX-License-Identifier: Apache-2.0
// What the renderer reads from the tables against the integrals that they stand for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "welkin/core/units.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/atmosphere_glsl.h"

namespace welkin::sky {
namespace {

using shared::vec3;

double luminance(const vec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}
vec3 directionAt(double elevationDeg, double azimuthDeg) {
  const double e = radians(elevationDeg), a = radians(azimuthDeg);
  return vec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
}

struct Scene {
  Atmosphere air;
  double eyeM;
  std::vector<Light> lights;
  SkyTables tables;
  shared::Atmosphere shared;

  Scene(double visibilityM, double eye, std::vector<Light> l)
      : air({}, visibilityM, 0.0, vec3(0.2f)),
        eyeM(eye),
        lights(std::move(l)),
        tables(makeSkyTables(air, eye, lights)),
        shared(shared::fromUniforms(air.uniforms())) {}

  vec3 sky(const vec3& dir) const {
    return shared::atmosphereSkyLuminance(shared, {&tables.skyView}, static_cast<float>(eyeM), dir,
                                          lights[0].direction);
  }
  // March with many small steps.
  void fineAerial(const vec3& dir, double distanceM, vec3& inscatter, vec3& through) const {
    shared::AtmosphereRay ray = shared::atmosphereRayAtEye();
    constexpr int kSteps = 1000;
    float t0 = 0.0f;
    for (int i = 1; i <= kSteps; ++i) {
      const float x = static_cast<float>(i) / kSteps, t1 = static_cast<float>(distanceM) * x * x;
      shared::atmosphereMarch(shared, {&air.transmittance()}, {&air.multipleScattering()},
                              static_cast<float>(eyeM), dir, shared::lightPair(lights, 0), t0, t1, ray);
      t0 = t1;
    }
    inscatter = ray.inscatter;
    through = ray.transmittance;
  }
  void aerial(const vec3& dir, double distanceM, vec3& inscatter, vec3& through) const {
    shared::atmosphereAerial(shared, {&tables.aerialInscatter, glsl::Wrap::kClamp},
                             {&tables.aerialTransmittance, glsl::Wrap::kClamp}, static_cast<float>(eyeM), dir,
                             lights[0].direction, static_cast<float>(distanceM), inscatter, through);
  }
};

std::vector<Light> sunAt(double elevationDeg) {
  return {{directionAt(elevationDeg, 37), 133100.0f * sunlightColour()}};
}

TEST(SkyTables, SkyViewMatchesTheMarch) {
  const Scene scenes[] = {
      {40e3, 2.0, sunAt(50)}, {40e3, 2.0, sunAt(3)}, {40e3, 2.0, sunAt(-4)}, {20e3, 10000.0, sunAt(15)}};
  for (const Scene& s : scenes) {
    double sum = 0.0, worst = 0.0;
    int n = 0;
    const double horizonDeg =
        degrees(std::asin(shared::atmosphereHorizonMu(s.shared, static_cast<float>(s.eyeM))));
    for (double above : {0.2, 1.0, 3.0, 8.0, 20.0, 45.0, 70.0, 89.0}) {
      for (double azimuth = 0; azimuth < 360; azimuth += 17) {
        const vec3 d = directionAt(horizonDeg + above, azimuth);
        const double want = luminance(s.air.skyLuminance(s.eyeM, d, s.lights));
        const double error = std::abs(luminance(s.sky(d)) / want - 1.0);
        sum += error;
        worst = std::max(worst, error);
        ++n;
      }
    }
    EXPECT_LT(sum / n, 0.006) << s.eyeM;
    EXPECT_LT(worst, 0.05) << s.eyeM;
  }
}

// The number of steps is enough: four times as many change little.
TEST(SkyTables, MarchHasConverged) {
  for (double sunElevation : {50.0, 2.0, -3.0, -6.0}) {
    for (double eye : {2.0, 12000.0}) {
      const Scene s(40e3, eye, sunAt(sunElevation));
      for (double elevation : {-2.0, 0.3, 2.0, 10.0, 40.0, 90.0}) {
        for (double azimuth : {37.0, 100.0, 217.0}) {
          const vec3 d = directionAt(elevation, azimuth);
          const auto ray = [&](float quality) {
            return luminance(shared::atmosphereSkyRay(s.shared, {&s.air.transmittance()},
                                                      {&s.air.multipleScattering()}, static_cast<float>(eye),
                                                      d, shared::lightPair(s.lights, 0), quality));
          };
          EXPECT_NEAR(ray(1.0f) / ray(8.0f), 1.0, 0.04)
              << sunElevation << " " << eye << " " << elevation << " " << azimuth;
        }
      }
    }
  }
}

// In thick haze, too: no more light than falls on it, less and less, of the haze's own colour; and all of it
// is before what is far away.
TEST(SkyTables, HoldInThickHaze) {
  double before = 1e9;
  for (const double visibilityM : {1000.0, 500.0, 200.0, 100.0, 50.0, 20.0, 10.0}) {
    SCOPED_TRACE(visibilityM);
    const Scene s(visibilityM, 2.0, sunAt(50));
    double mean = 0.0;
    for (const double elevation : {5.0, 20.0, 60.0})
      for (const double azimuth : {80.0, 127.0, 217.0}) {
        const vec3 d = directionAt(elevation, azimuth), sky = s.sky(d);
        EXPECT_LT(luminance(sky), 133100.0 / kPi);
        EXPECT_LT(std::max({sky.x, sky.y, sky.z}), 2.0f * std::min({sky.x, sky.y, sky.z}));
        mean += luminance(sky) / 9.0;
        if (visibilityM > 300.0) continue;
        vec3 inscatter, through;
        s.aerial(d, 5000.0, inscatter, through);
        EXPECT_NEAR(luminance(inscatter) / luminance(sky), 1.0, 0.05) << elevation << " " << azimuth;
      }
    EXPECT_LT(mean, before);
    before = mean;
  }
}

TEST(SkyTables, NoSeamsInAzimuthAndAtTheZenith) {
  const Scene s(40e3, 2.0, sunAt(20));
  for (double elevation : {1.0, 30.0, 80.0}) {
    const double opposite = 37.0 + 180.0;
    const vec3 a = s.sky(directionAt(elevation, opposite - 0.01)),
               b = s.sky(directionAt(elevation, opposite + 0.01));
    EXPECT_NEAR(luminance(a) / luminance(b), 1.0, 1e-3);
  }
  const double zenith = luminance(s.sky(vec3(0, 0, 1)));
  for (double azimuth = 0; azimuth < 360; azimuth += 30) {
    EXPECT_NEAR(luminance(s.sky(directionAt(89.9, azimuth))) / zenith, 1.0, 0.01);
  }
}

// A band would stand out in second differences along a meridian: the table's must be those of the march.
TEST(SkyTables, NoBands) {
  for (double sunElevation : {40.0, 1.0, -5.0}) {
    const Scene s(40e3, 2.0, sunAt(sunElevation));
    for (double azimuth : {37.0, 120.0, 217.0}) {
      for (double elevation = 1.0; elevation < 85.0; elevation *= 1.05) {
        double table = 0.0, march = 0.0;
        for (int i = -1; i <= 1; ++i) {
          const vec3 d = directionAt(elevation * std::pow(1.05, i), azimuth);
          const double weight = i == 0 ? -2.0 : 1.0;
          table += weight * std::log(luminance(s.sky(d)));
          march += weight * std::log(luminance(s.air.skyLuminance(s.eyeM, d, s.lights)));
        }
        EXPECT_NEAR(table, march, 0.02) << sunElevation << " " << azimuth << " " << elevation;
      }
    }
  }
}

TEST(SkyTables, AerialMatchesAFineMarch) {
  const Scene scenes[] = {{40e3, 2.0, sunAt(40)}, {10e3, 2.0, sunAt(10)}, {40e3, 8000.0, sunAt(25)}};
  for (const Scene& s : scenes) {
    for (double elevation : {-30.0, -5.0, 0.5, 3.0, 15.0, 60.0}) {
      for (double azimuth : {37.0, 110.0, 200.0}) {
        const vec3 d = directionAt(elevation, azimuth);
        const float ground = shared::atmosphereDistanceToGround(s.shared, static_cast<float>(s.eyeM), d.z);
        for (double distance : {50.0, 700.0, 3000.0, 12000.0, 60000.0, 200000.0}) {
          if (ground >= 0.0f && distance > ground) continue;
          vec3 wantLight, wantThrough, light, through;
          s.fineAerial(d, distance, wantLight, wantThrough);
          s.aerial(d, distance, light, through);
          const auto where = testing::Message()
                             << s.eyeM << " m, " << elevation << ", " << azimuth << ", " << distance << " m";
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(through[c], wantThrough[c], 0.02) << where;
          EXPECT_NEAR(luminance(light), luminance(wantLight), 0.06 * luminance(wantLight) + 25.0) << where;
        }
      }
    }
  }
}

TEST(SkyTables, NoAirBeforeNoDistance) {
  const Scene s(40e3, 2.0, sunAt(40));
  vec3 light, through;
  s.aerial(directionAt(5, 80), 0.0, light, through);
  EXPECT_EQ(light, vec3(0.0f));
  EXPECT_EQ(through, vec3(1.0f));
}

// A far end of the air is the sky itself.
TEST(SkyTables, AerialEndsInTheSky) {
  const Scene s(40e3, 2.0, sunAt(35));
  for (double elevation : {15.0, 40.0, 80.0}) {
    const vec3 d = directionAt(elevation, 150);
    vec3 light, through;
    s.aerial(d, 499e3, light, through);
    EXPECT_NEAR(luminance(light) / luminance(s.sky(d)), 1.0, 0.04) << elevation;
  }
}

// Mirrored and left-out lights change nothing: a moon by day, and two lights against the sum of their
// marches.
TEST(SkyTables, TwoLights) {
  const Light moon{directionAt(50, 160), 0.2f * moonlightColour()};
  std::vector<Light> day = sunAt(30);
  day.push_back(moon);
  const Scene one(40e3, 2.0, sunAt(30)), two(40e3, 2.0, day);
  EXPECT_EQ(one.tables.skyView.data, two.tables.skyView.data);

  std::vector<Light> dusk = sunAt(-9.5);
  dusk.insert(dusk.begin(), moon);
  const Scene s(40e3, 2.0, dusk);
  for (double elevation : {5.0, 30.0, 70.0}) {
    for (double azimuth : {0.0, 40.0, 170.0, 300.0}) {
      const vec3 d = directionAt(elevation, azimuth);
      EXPECT_NEAR(luminance(s.sky(d)) / luminance(s.air.skyLuminance(2.0, d, dusk)), 1.0, 0.03)
          << elevation << " " << azimuth;
    }
  }
}

TEST(SkyTables, InPortionsAreTheSame) {
  const Atmosphere air(AtmosphereParams{}, 20e3, 0.0, glm::vec3(0.2f));
  const std::vector<Light> lights = {{glm::normalize(glm::vec3(1, 0, 0.3)), glm::vec3(1e5f)},
                                     {glm::normalize(glm::vec3(0, 1, 0.5)), glm::vec3(5e4f)},
                                     {glm::normalize(glm::vec3(-1, 1, 0.9)), glm::vec3(5e4f)}};
  const SkyTables whole = makeSkyTables(air, 100.0, lights);
  SkyTablesInProgress making;
  making.start(air, 100.0, std::span(lights).first(1));  // and given up
  making.computeTo(7);
  making.start(air, 100.0, lights);
  for (int row = 0; row < making.rows() + 13; row += 13) making.computeTo(row);
  EXPECT_EQ(making.tables().skyView.data, whole.skyView.data);
  EXPECT_EQ(making.tables().aerialInscatter.data, whole.aerialInscatter.data);
  EXPECT_EQ(making.tables().aerialTransmittance.data, whole.aerialTransmittance.data);
}

TEST(SkyTables, NightHasAirglow) {
  const Scene s(40e3, 2.0, {{directionAt(-40, 0), 133100.0f * sunlightColour()}});
  EXPECT_NEAR(luminance(s.sky(vec3(0, 0, 1))), 1.7e-4, 4e-5);
}

}  // namespace
}  // namespace welkin::sky
