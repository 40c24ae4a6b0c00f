// SPDX-License-Identifier: Apache-2.0
// The clear sky's light between key instants.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

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
      EXPECT_NEAR(
          state.clearSky[0].ground.total.y > 0.0f ? state.ambient.skyLow.y * 3.14159265f / exact : 0.0f, 1.0f,
          0.005f)
          << time << " " << t;
    }
  }
}

// Scenes that code has made are checked as files are.
TEST(SkyState, NonsenseIsNoSky) {
  const auto problem = [](const std::function<void(Scene&)>& change, double at = 0.0) -> std::string {
    Scene s;
    s.layers.push_back(weather::typicalLayer(weather::Genus::kCumulus, 47.0));
    change(s);
    try {
      buildSky(s, at);
    } catch (const ParameterError& e) {
      return e.what();
    }
    return "";
  };
  const double nan = std::nan("");
  EXPECT_EQ(problem([](Scene&) {}), "");
  EXPECT_NE(problem([&](Scene& s) { s.place.latitudeDeg = nan; }).find("latitude_deg"), std::string::npos);
  EXPECT_NE(problem([](Scene& s) { s.place.latitudeDeg = 123.0; }).find("-90 to 90"), std::string::npos);
  EXPECT_NE(problem([](Scene& s) { s.time.month = 13; }).find("calendar"), std::string::npos);
  EXPECT_NE(problem([](Scene& s) { s.atmosphere.ozoneDu = -100.0; }).find("ozone_du"), std::string::npos);
  EXPECT_NE(problem([](Scene& s) { s.layers[0].oktas = 12.0; }), "");
  EXPECT_NE(problem([](Scene& s) { s.slab.opticalDepth = 4.0; }).find("traceSlab"), std::string::npos);
  for (const double at : {nan, 1e10, -1e300})
    EXPECT_NE(problem([](Scene&) {}, at).find("the instant is"), std::string::npos) << at;
  SkyState sky = buildSky(Scene{}, 0.0);
  EXPECT_THROW(moveSky(sky, nan), ParameterError);
}

TEST(ClearSkyKey, ASequenceHasTheStillsLight) {
  Scene s;
  s.time = parseUtcTime("2026-06-21T17:00:00Z");
  SkyState last = buildSky(s, 0.0), moved = last;
  for (const double t : {10.0, 29.0, 31.0, 400.0, 30.0, -5.0}) {
    last = buildSky(s, t, &last);
    moveSky(moved, t);
    const SkyState still = buildSky(s, t);
    for (const SkyState* state : {&last, &moved}) {
      EXPECT_EQ(state->ambient.skyLow, still.ambient.skyLow) << t;
      EXPECT_EQ(state->ambient.skyHigh, still.ambient.skyHigh) << t;
      EXPECT_EQ(state->ambient.aboveLow, still.ambient.aboveLow) << t;
      EXPECT_EQ(state->clearSky, still.clearSky) << t;
    }
  }
}

TEST(ClearSkyKey, LightFromAboveIsBluerAndLessTheHigher) {
  Scene s;
  s.time = parseUtcTime("2026-06-21T11:00:00Z");
  const SkyState state = buildSky(s, 0.0);
  const AmbientLight& a = state.ambient;
  const auto blueness = [](const sky::LightMoments& m) { return m.total.z / m.total.x; };
  EXPECT_GT(a.above.total.y, a.aboveLow.total.y);
  EXPECT_GT(a.aboveLow.total.y, a.aboveHigh.total.y);
  EXPECT_GT(blueness(a.aboveLow), 1.1f * blueness(a.above));
  EXPECT_GT(blueness(a.aboveHigh), 1.1f * blueness(a.aboveLow));
}

TEST(ClearSkyKey, InPortionsIsTheSame) {
  Scene s;
  s.time = parseUtcTime("2026-06-21T17:00:00Z");
  SkyState state = buildSky(s, 0.0);
  ClearSkyKeyInProgress making;
  for (int i = 0; i < 2; ++i) {
    making.start(state, 90.0);
    for (int part = 5; part < ClearSkyKeyInProgress::kParts + 5; part += 5) making.computeTo(part);
    EXPECT_EQ(making.key(), buildSky(s, 90.0).clearSky[0]);
  }
  // Known ahead, it is taken.
  state.clearSkyAhead = making.key();
  state.clearSkyAhead->ground.total.x = 1.0f;
  moveSky(state, 95.0);
  EXPECT_EQ(state.clearSky[0].ground.total.x, 1.0f);
}

}  // namespace
}  // namespace welkin::scene
