// SPDX-License-Identifier: Apache-2.0
// Cover calibrated ahead of frames.
#include "welkin/render/cover_ahead.h"

#include <gtest/gtest.h>

#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

scene::Scene windyScene() {
  scene::Scene s;
  s.metar = "EGLL 211120Z 24020KT 9999 SCT030 14/12 Q1013";
  s.time = parseUtcTime("2026-07-21T11:20:00Z");
  return s;
}

TEST(CoverAhead, HasTheNextKeyInstantBeforeItsFrame) {
  const scene::Scene s = windyScene();
  for (const double direction : {1.0, -1.0}) {
    scene::SkyState state = scene::buildSky(s, direction);
    const double interval = state.coverKeyS, next = direction > 0.0 ? 2.0 * interval : -2.0 * interval;
    ASSERT_GT(interval, 0.0);
    CoverAhead ahead;
    for (double t = 1.0; t < interval; t += interval / 40.0) {
      scene::moveSky(state, direction * t);
      ahead.prepare(state);
    }
    ASSERT_TRUE(state.coverKeyAhead);
    EXPECT_EQ(state.coverKeyAhead->atS, next);
    scene::moveSky(state, direction * (interval + 1.0));
    const scene::SkyState still = scene::buildSky(s, direction * (interval + 1.0));
    EXPECT_EQ(state.calibration, still.calibration);
    EXPECT_EQ(state.coverKeys, still.coverKeys);
  }
}

TEST(CoverAhead, IsNothingToASkyWithoutVolumes) {
  scene::Scene s = windyScene();
  s.metar = "EGLL 211120Z 24020KT CAVOK 14/12 Q1013";
  scene::SkyState state = scene::buildSky(s, 0.0);
  CoverAhead().prepare(state);
  EXPECT_FALSE(state.coverKeyAhead);
}

// What is under way for one instant is never taken for another's.
TEST(CoverAhead, StartsAnewWhereTimeJumps) {
  scene::SkyState state = scene::buildSky(windyScene(), 1.0);
  CoverAhead ahead;
  for (const double t : {1.0, 8.0, 5000.0, 5001.0, 8.0, 2.0}) {
    scene::moveSky(state, t);
    ahead.prepare(state);
    EXPECT_EQ(state.calibration, scene::buildSky(windyScene(), t).calibration) << t;
  }
}

}  // namespace
}  // namespace welkin::render
