// SPDX-License-Identifier: Apache-2.0
// Sun and moon of traced skies in eclipses. What lib/background.glsl draws of them:
// tests/unit/render/environment_map_test.cpp.
#include "welkin/reference/sky_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/core/utc_time.h"
#include "welkin/reference/directions.h"
#include "welkin/sky/light.h"

namespace welkin::reference {
namespace {

scene::SkyState skyAt(const char* time, const scene::Place& place) {
  scene::Scene scene = testing::clearScene(20.0);
  scene.time = parseUtcTime(time);
  scene.place = place;
  return scene::buildSky(scene, 0.0);
}

struct Lit {
  explicit Lit(const scene::SkyState& state)
      : earth(state.clouds->earthRadiusM()), air(state.atmosphere->uniforms()), lights(state, air, earth) {}
  Sphere earth;
  Air air;
  SkyLights lights;
};

// Light of all that is drawn within some degrees of a direction, lux.
glm::dvec3 lightOf(const SkyLights& lights, const glm::dvec3& middle, double halfRad, int side) {
  const glm::dvec3 m = glm::normalize(middle), right = turned(m, 0.0, 0.0), up = glm::cross(m, right);
  glm::dvec3 sum(0.0);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double x = halfRad * (2.0 * (i + 0.5) / side - 1.0), y = halfRad * (2.0 * (j + 0.5) / side - 1.0);
      sum += lights.discs(glm::normalize(m + x * right + y * up));
    }
  return sum * std::pow(2.0 * halfRad / side, 2);
}

const scene::Place kLeon{42.5987, -5.5671, 840.0};

TEST(SkyLights, TheEclipsedSunIsAsBrightAsItsLight) {
  for (const char* time : {"2026-08-12T18:00:00Z", "2026-08-12T18:19:00Z", "2026-08-12T18:27:00Z"}) {
    const scene::SkyState state = skyAt(time, kLeon);
    const Lit lit(state);
    const sky::Light sun = sky::sunLight(state.ephemeris);
    const glm::dvec3 drawn = lightOf(lit.lights, state.ephemeris.sun.direction, 0.006, 1200);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(drawn[c] / static_cast<double>(sun.illuminance[c]), 1.0, 0.01) << time;
  }
}

TEST(SkyLights, TheEclipsedMoonIsAsBrightAsItsLight) {
  for (const char* time : {"2025-03-14T04:40:00Z", "2025-03-14T05:50:00Z", "2025-03-14T06:59:00Z"}) {
    const scene::SkyState state = skyAt(time, {40.0, -100.0, 0.0});
    const Lit lit(state);
    const sky::Light moon = sky::moonLight(state.ephemeris);
    const glm::dvec3 drawn = lightOf(lit.lights, state.ephemeris.moon.direction, 0.006, 600);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(drawn[c] / static_cast<double>(moon.illuminance[c]), 1.0, 0.03) << time;
  }
}

TEST(SkyLights, TheUmbraHasAnEdge) {
  const scene::SkyState state = skyAt("2026-08-12T18:29:04Z", kLeon);
  const Lit lit(state);
  Random random(1);
  const auto brightness = [&](const glm::dvec3& p) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 64; ++i) sum += lit.lights.illuminance(lit.lights.sample(p, random), p);
    return sum.y / 64.0;
  };
  // 30 km above the ground all of the sun's light would be some 100,000 lux.
  EXPECT_LT(brightness({0.0, 0.0, 30e3}), 1.0);
  EXPECT_LT(brightness({0.0, 40e3, 30e3}), 1.0);
  EXPECT_GT(brightness({0.0, 300e3, 30e3}), 500.0);
  EXPECT_GT(brightness({0.0, 600e3, 30e3}), brightness({0.0, 300e3, 30e3}));
}

}  // namespace
}  // namespace welkin::reference
