// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs by hand, at an instant about an eye.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/testing/metaball_scene.h"
#include "tests/testing/skies.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

std::vector<field::Metaball> rowOfBalls(int count, double radiusM) {
  std::vector<field::Metaball> balls;
  for (int i = 0; i < count; ++i) balls.push_back({{20.0 * i, 0.0, 0.0}, radiusM, 0.01});
  return balls;
}

// The finer level goes on living as it did while a coarser one fades in before it.
TEST(MetaballSky, LevelsLiveByThemselves) {
  const testing::MetaballFolder folder;
  Scene s = testing::clearScene(50.0);
  s.metaballs = {folder.levels({rowOfBalls(7, 30.0), rowOfBalls(40, 10.0)}, {0.0, 0.0, 0.0})};
  s.metaballs[0].lifeS = 100.0;
  const SkyState state = buildSky(s, 0.0);
  const auto ballsFrom = [&](double distanceM, MetaballDetail detail) {
    CloudBalls balls;
    state.metaballs->at(37.0, {400.0, -distanceM, 0.0}, state.clouds->earthRadiusM(), balls, detail);
    return balls;
  };
  bool faded = false;
  for (double distanceM = 8000.0; distanceM < 16000.0; distanceM += 500.0) {
    const CloudBalls seen = ballsFrom(distanceM, MetaballDetail::kAsBalls),
                     finest = ballsFrom(distanceM, MetaballDetail::kFinest);
    const CloudBalls::Cloud& cloud = seen.clouds[0];
    if (cloud.coarseEnd == cloud.end) continue;  // one level alone
    faded = true;
    ASSERT_EQ(cloud.end - cloud.coarseEnd, finest.balls.size());
    EXPECT_TRUE(std::equal(finest.balls.begin(), finest.balls.end(),
                           seen.balls.begin() + static_cast<std::ptrdiff_t>(cloud.coarseEnd),
                           [](const field::Metaball& a, const field::Metaball& b) {
                             return a.centreM == b.centreM && a.radiusM == b.radiusM;
                           }))
        << distanceM;
  }
  EXPECT_TRUE(faded);
}

}  // namespace
}  // namespace welkin::scene
