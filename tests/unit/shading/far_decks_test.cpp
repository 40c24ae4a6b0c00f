// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/far_decks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/testing/skies.h"
#include "welkin/core/units.h"

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

TEST(FarDecks, TakeNothingFromAHighSunAndNearlyAllFromALowOne) {
  const FarDecks decks = decksOf({Genus::kCirrus}, 8.0);
  for (const double heightM : {0.0, 5000.0, 9000.0, 17000.0}) {
    double last = 1.0;
    for (const double degrees : {30.0, 5.0, 2.5, 1.5, 0.8, 0.4, 0.1, 0.0}) {
      const double through = decks.through(heightM, std::sin(radians(degrees)), true);
      EXPECT_LE(through, last + 1e-12) << heightM << " m, " << degrees;
      if (degrees > 2.1) {
        EXPECT_EQ(through, 1.0) << heightM << " m, " << degrees;
      }
      last = through;
    }
    // Above all cloud nothing is in the way.
    EXPECT_TRUE(heightM > 15e3 ? last == 1.0 : last < 0.05) << heightM << " m: " << last;
  }
  EXPECT_LT(decks.through(17000.0, std::sin(radians(-3.2)), true), 0.05);  // by way of the clouds beneath
}

// What the line knows and what is added to it are the whole way, however low the light stands.
TEST(FarDecks, DoNotJump) {
  for (const double oktas : {1.0, 4.0, 8.0}) {
    const FarDecks decks = decksOf({Genus::kAltocumulus, Genus::kCirrus}, oktas);
    for (const double heightM : {0.0, 3000.0, 9000.0})
      for (double sine = -0.06; sine < 0.06; sine += 1e-4)
        EXPECT_NEAR(decks.through(heightM, sine, true), decks.through(heightM, sine + 1e-4, true), 0.02)
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
