// SPDX-License-Identifier: Apache-2.0
// Which lights metaballs are lit by.
#include "welkin/shading/splat_lights.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/testing/skies.h"
#include "welkin/shading/uniforms.h"

namespace welkin::shading {
namespace {

using namespace welkin::testing;

// The day before the full moon of a December: it stands in the east before the sun has set.
scene::SkyState winterEvening(const char* time) {
  scene::Scene s = moonlitScene();
  s.time = parseUtcTime(time);
  return scene::buildSky(s, 0.0);
}

TEST(SplatLights, TheMoonCountsWhereItIsSeen) {
  const scene::SkyState day = winterEvening("2026-12-23T16:45:00Z"),
                        dusk = winterEvening("2026-12-23T17:33:00Z"),
                        night = winterEvening("2026-12-23T21:00:00Z");
  for (const scene::SkyState* s : {&day, &dusk, &night})
    EXPECT_GT(s->ephemeris.moon.elevationDeg, 1.0);  // it is up
  EXPECT_TRUE(day.litBySun && dusk.litBySun && !night.litBySun);
  EXPECT_FALSE(splatLights(day).toSecond);
  ASSERT_TRUE(splatLights(dusk).toSecond);
  EXPECT_EQ(*splatLights(dusk).toSecond, dusk.lights[1].direction);
  EXPECT_FALSE(splatLights(night).toSecond);  // the sun is far below
}

// It begins to count when it is a two-hundredth of all light there is: nobody sees it come.
TEST(SplatLights, ItComesUnseen) {
  scene::SkyState state = winterEvening("2026-12-23T16:50:00Z");
  double s = 0.0;
  while (!secondLightSeen(state) && s < 3600.0) state = scene::buildSky(state.scene, s += 30.0, &state);
  ASSERT_TRUE(secondLightSeen(state));
  const double moonLux = static_cast<double>(state.lights[1].illuminance.y);
  const double skyLux = static_cast<double>(state.ambient.skyLow.y) * 3.14159;
  EXPECT_LT(moonLux, 0.02 * skyLux);
  EXPECT_NEAR(state.ephemeris.sun.elevationDeg, -4.0, 1.0);
}

TEST(SplatLights, TheSkyIsBrightestOverTheSunThatHasSet) {
  for (const double elevationDeg : {15.0, 2.0, -4.0}) {
    const scene::SkyState state = scene::buildSky(clearScene(elevationDeg), 0.0);
    const glm::vec3 sun = state.lights[0].direction, glow = splatLights(state).toGlow;
    EXPECT_NEAR(glm::length(glow), 1.0f, 1e-5f);
    EXPECT_EQ(glow.z, 0.0f);
    EXPECT_GT(glm::dot(glow, glm::normalize(glm::vec3(sun.x, sun.y, 0.0f))), 0.98f) << elevationDeg;
  }
}

// As the key light's table, of whichever light.
TEST(SplatLights, ATableIsOfItsLight) {
  const scene::SkyState dusk = winterEvening("2026-12-23T17:33:00Z");
  Image<float> sun, moon;
  lightTable(dusk, dusk.lights[0], sun);
  lightTable(dusk, dusk.lights[1], moon);
  const int low = 4, middle = sun.height / 2;
  EXPECT_EQ(sun.at(low, middle, 1), 0.0f);  // in the earth's shadow
  EXPECT_GT(moon.at(low, middle, 1), 0.1f * dusk.lights[1].illuminance.y);
  EXPECT_LT(moon.at(low, middle, 1), dusk.lights[1].illuminance.y);
}

}  // namespace
}  // namespace welkin::shading
