// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/far_decks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"

namespace welkin::shading {
namespace {

using weather::Genus;

FarDecks decksOf(std::initializer_list<Genus> genera, double oktas) {
  return FarDecks(scene::buildSky(testing::cloudyScene(20.0, genera, oktas), 0.0));
}

TEST(FarDecks, ThereAreNoneInAClearSky) {
  const FarDecks decks = decksOf({}, 0.0);
  EXPECT_FALSE(decks.any());
  EXPECT_EQ(decks.through(1000.0, -0.02, true), 1.0);
  EXPECT_FALSE(decks.lineTowards(-0.02));
}

// A way that is level within a deck is longest; from beneath, over the curved earth, it is no longer than the
// line's.
TEST(FarDecks, TakeNothingFromAHighSunAndNearlyAllFromALowOneWithinThem) {
  const scene::SkyState state = scene::buildSky(testing::cloudyScene(20.0, {Genus::kCirrus}, 8.0), 0.0);
  const FarDecks decks(state);
  const field::CloudLayer& layer = state.clouds->layers()[0];
  const double middle = 0.5 * static_cast<double>(layer.baseM + layer.topM), above = layer.topM + 500.0;
  double last = 1.0;
  for (const double degrees : {30.0, 5.0, 2.5, 1.5, 0.8, 0.4, 0.1, 0.0, -0.3, -0.6}) {
    const double sine = std::sin(radians(degrees)), through = decks.through(middle, sine, true);
    EXPECT_LE(through, last + 1e-12) << degrees;
    if (degrees > 2.1) {
      EXPECT_EQ(through, 1.0) << degrees;
    }
    last = through;
    EXPECT_EQ(decks.through(0.0, std::abs(sine), true), 1.0) << degrees;
    if (degrees >= 0.0) {
      EXPECT_EQ(decks.through(above, sine, true), 1.0) << degrees;
    }
  }
  EXPECT_LT(last, 0.01);
  EXPECT_LT(decks.through(above, std::sin(radians(-1.5)), true), 0.05);  // by way of the clouds beneath
}

// What the line knows and what is added to it are the whole way, however low the light stands.
TEST(FarDecks, DoNotJump) {
  for (const double oktas : {1.0, 4.0, 8.0}) {
    const FarDecks decks = decksOf({Genus::kAltocumulus, Genus::kCirrus}, oktas);
    for (const double heightM : {0.0, 2000.0, 3500.0, 9000.0})
      for (const double sine : {-0.035, 0.0, 0.035})
        EXPECT_NEAR(decks.through(heightM, sine - 1e-6, true), decks.through(heightM, sine + 1e-6, true),
                    1e-3)
            << heightM << " m, " << sine;
  }
}

TEST(FarDecks, SparseCloudsAreLitFromBelow) {
  EXPECT_TRUE(decksOf({Genus::kStratocumulus}, 6.0).lineTowards(-0.1));
  EXPECT_TRUE(decksOf({Genus::kStratocumulus}, 6.0).lineTowards(0.0));
  EXPECT_FALSE(decksOf({Genus::kCirrus}, 0.05).lineTowards(-0.02));
}

}  // namespace
}  // namespace welkin::shading
