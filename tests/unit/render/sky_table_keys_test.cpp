// SPDX-License-Identifier: Apache-2.0
// Blended tables of the clear sky against those of the very instant and height.
#include "welkin/render/sky_table_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/testing/skies.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

TEST(SkyTableKeys, LevelsAreHeights) {
  EXPECT_EQ(SkyTableKeys::heightM(0), 0.0);
  for (int level = 1; level < 200; ++level) {
    const double h = SkyTableKeys::heightM(level), step = h - SkyTableKeys::heightM(level - 1);
    EXPECT_NEAR(SkyTableKeys::levelOf(h), level, 1e-6);
    EXPECT_GE(step, 124.0);
    EXPECT_LE(step, 2501.0);
    EXPECT_LE(step, 0.14 * h + 133.0);
  }
  EXPECT_EQ(SkyTableKeys::levelOf(-5.0), 0.0);
}

TEST(SkyTableKeys, PlacesGoOnFromKeyToKey) {
  scene::SkyState state;
  double before = -1.0;
  for (double eyeM = 0.0; eyeM < 60e3; eyeM += 1.0) {
    const SkyTableKeys::Place p = SkyTableKeys::placeOf(state, eyeM);
    ASSERT_TRUE(p.heightWeight >= 0 && p.heightWeight < SkyTableKeys::kWeights) << eyeM;
    const double low = SkyTableKeys::heightM(p.level), high = SkyTableKeys::heightM(p.level + 1);
    const double at = low + (high - low) * p.heightWeight / SkyTableKeys::kWeights;
    ASSERT_GE(at, before);
    ASSERT_NEAR(at, eyeM, (high - low) / SkyTableKeys::kWeights + 1e-6);
    before = at;
  }
  for (const double eyeM : {-1e9, 1e300}) {
    const SkyTableKeys::Place p = SkyTableKeys::placeOf(state, eyeM);
    EXPECT_TRUE(p.level >= 0 && p.heightWeight >= 0 && p.heightWeight < SkyTableKeys::kWeights) << eyeM;
  }
}

// Mean and largest relative difference of luminance above the horizon.
struct Errors {
  double mean = 0.0, worst = 0.0;
};
Errors errorsAboveHorizon(const Image<float>& have, const Image<float>& want) {
  Errors e;
  const int half = want.height / 2;
  for (int y = half; y < want.height; ++y)
    for (int x = 0; x < want.width; ++x) {
      const double error = std::abs(have.at(x, y, 1) / static_cast<double>(want.at(x, y, 1)) - 1.0);
      e.mean += error / ((want.height - half) * want.width);
      e.worst = std::max(e.worst, error);
    }
  return e;
}

TEST(SkyTableKeys, BlendedTablesAreNearExactOnes) {
  for (const double sunDeg : {50.0, 3.0, -4.0}) {
    const scene::SkyState state = scene::buildSky(clearScene(sunDeg), 10.0);
    SkyTableKeys keys;
    for (const double eyeM : {70.0, 400.0, 3200.0, 10500.0, 19000.0}) {
      sky::SkyTables blended;
      keys.blend(state, SkyTableKeys::placeOf(state, eyeM), blended);
      const sky::SkyTables exact = sky::makeSkyTables(*state.atmosphere, eyeM, state.lights);
      const Errors e = errorsAboveHorizon(blended.skyView, exact.skyView);
      EXPECT_LT(e.mean, 0.008) << sunDeg << " degrees, " << eyeM << " m";
      EXPECT_LT(e.worst, eyeM > 15e3 ? 0.1 : 0.05) << sunDeg << " degrees, " << eyeM << " m";
      // As seen at the greatest distance, towards the horizon and down.
      const auto& through = exact.aerialTransmittance;
      for (int j = 0; j < through.ny; ++j)
        EXPECT_NEAR(blended.aerialTransmittance.at(0, j, through.nz / 2, 1),
                    through.at(0, j, through.nz / 2, 1), 0.02);
    }
  }
}

// Whatever was made before, a portion or all of it.
TEST(SkyTableKeys, AnyWayToAPlaceGivesItsTables) {
  const scene::Scene scene = clearScene(20.0);
  scene::SkyState state = scene::buildSky(scene, 0.0);
  SkyTableKeys walking;
  sky::SkyTables walked;
  for (int i = 0; i < 40; ++i) {
    scene::moveSky(state, 1.7 * i);
    const double eyeM = 100.0 + 25.0 * i;
    const SkyTableKeys::Place place = SkyTableKeys::placeOf(state, eyeM);
    walking.keep(place, 0);
    walking.blend(state, place, walked);
    walking.prepare(state, place, eyeM, 0);
  }
  const double lastM = 100.0 + 25.0 * 39;
  SkyTableKeys direct;
  sky::SkyTables tables;
  direct.blend(state, SkyTableKeys::placeOf(state, lastM), tables);
  EXPECT_EQ(walked.skyView.data, tables.skyView.data);
  EXPECT_EQ(walked.aerialInscatter.data, tables.aerialInscatter.data);
  EXPECT_EQ(walked.aerialTransmittance.data, tables.aerialTransmittance.data);
}

}  // namespace
}  // namespace welkin::render
