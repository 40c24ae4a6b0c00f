// SPDX-License-Identifier: Apache-2.0
// The clear sky's light between key instants.
#include <gtest/gtest.h>

#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

TEST(ClearSkyKey, LightBetweenKeysIsThatOfTheInstant) {
  Scene s;
  s.place = {47.0, 8.0, 0.0};
  for (const char* time : {"2026-06-21T12:00:00Z", "2026-06-21T19:50:00Z"}) {  // noon, the end of dusk
    s.time = parseUtcTime(time);
    for (const double t : {-44.0, 12.0, 45.0}) {
      const SkyState state = buildSky(s, t);
      const float exact = state.atmosphere->skyIlluminance(0.0, state.lights).y;
      EXPECT_NEAR(state.clearSky[0].ground.y > 0.0f ? state.ambient.skyLow.y * 3.14159265f / exact : 0.0f,
                  1.0f, 0.005f)
          << time << " " << t;
    }
  }
}

TEST(ClearSkyKey, ASequenceHasTheStillsLight) {
  Scene s;
  s.time = parseUtcTime("2026-06-21T17:00:00Z");
  SkyState last = buildSky(s, 0.0);
  for (const double t : {10.0, 29.0, 31.0, 400.0, 30.0, -5.0}) {
    last = buildSky(s, t, &last);
    const SkyState still = buildSky(s, t);
    EXPECT_EQ(last.ambient.skyLow, still.ambient.skyLow) << t;
    EXPECT_EQ(last.ambient.skyHigh, still.ambient.skyHigh) << t;
  }
}

}  // namespace
}  // namespace welkin::scene
