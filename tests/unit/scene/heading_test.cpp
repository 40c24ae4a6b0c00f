// SPDX-License-Identifier: Apache-2.0
// Where a camera looks to that nobody has turned.
#include <gtest/gtest.h>

#include <cmath>

#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

Scene sceneAt(const char* time) {
  Scene s;
  s.time = parseUtcTime(time);
  s.output.width = 32;
  s.output.height = 18;
  return s;
}

double headingAt(const Scene& s, double secondsAfter = 0.0) {
  return buildSky(s, secondsAfter).headingDeg;
}

TEST(Heading, FollowsTheLightThatIsUp) {
  const Scene day = sceneAt("2026-06-21T12:20:00Z");
  EXPECT_NEAR(headingAt(day), buildSky(day, 0.0).ephemeris.sun.azimuthDeg + 60.0, 1e-9);
  // A high moon at night.
  const SkyState night = buildSky(sceneAt("2026-01-03T00:00:00Z"), 0.0);
  ASSERT_GT(night.ephemeris.moon.elevationDeg, 10.0);
  ASSERT_LT(night.ephemeris.sun.elevationDeg, -10.0);
  EXPECT_NEAR(night.headingDeg, std::fmod(night.ephemeris.moon.azimuthDeg + 60.0, 360.0), 1e-9);
}

TEST(Heading, GoesByTheAfterglowWhereTheMoonIsDown) {
  const SkyState dusk = buildSky(sceneAt("2026-06-08T20:20:00Z"), 0.0);
  ASSERT_FALSE(dusk.litBySun);
  ASSERT_LT(dusk.ephemeris.moon.elevationDeg, -10.0);
  EXPECT_NEAR(dusk.headingDeg, std::fmod(dusk.ephemeris.sun.azimuthDeg + 60.0, 360.0), 1e-9);
}

TEST(Heading, IsThatOfTheScenesTimeAtAllInstants) {
  const Scene s = sceneAt("2026-06-21T12:20:00Z");
  const SkyState first = buildSky(s, 0.0);
  EXPECT_EQ(headingAt(s, 7200.0), first.headingDeg);
  EXPECT_EQ(buildSky(s, 7200.0, &first).headingDeg, first.headingDeg);
  Scene turned = s;
  turned.camera.headingDeg = 12.0;
  EXPECT_EQ(headingAt(turned, 7200.0), 12.0);
  Scene whole = s;
  whole.camera.projection = Projection::kFisheye;
  EXPECT_EQ(headingAt(whole), 0.0);
}

}  // namespace
}  // namespace welkin::scene
