// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/mie_droplets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "welkin/core/units.h"
#include "welkin/optics/mie_phase.h"

namespace welkin::optics {
namespace {

double at(const Image<float>& table, double deg, int colour) {
  return table.at(static_cast<int>(std::lround(deg / 180.0 * (kMieAngles - 1))), 0, colour);
}

// The angle of the largest value between two others.
double peakBetween(const Image<float>& table, double from, double to, int colour) {
  double best = from;
  for (double deg = from; deg <= to; deg += 0.05)
    if (at(table, deg, colour) > at(table, best, colour)) best = deg;
  return best;
}

TEST(MieDroplets, IntegratesToOneInEachColour) {
  for (const double d : {4.0, 10.0, 20.0, 40.0}) {
    const Image<float> table = mieDroplets(d);
    ASSERT_EQ(table.width, kMieAngles);
    for (int colour = 0; colour < 3; ++colour) {
      constexpr int kFine = 8;  // points of the linear function between texels
      double sum = 0.0, mean = 0.0;
      for (int i = 0; i < (kMieAngles - 1) * kFine; ++i) {
        const double x = (i + 0.5) / kFine, angle = kPi * x / (kMieAngles - 1);
        const int k = static_cast<int>(x);
        const double share = x - k;
        const double p = (1.0 - share) * table.at(k, 0, colour) + share * table.at(k + 1, 0, colour);
        const double dOmega = 2.0 * kPi * std::sin(angle) * kPi / (kMieAngles - 1) / kFine;
        sum += p * dOmega;
        mean += p * dOmega * std::cos(angle);
      }
      EXPECT_NEAR(sum, 1.0, 1e-3) << d << " " << colour;
      EXPECT_NEAR(mean, 0.86, d < 8.0 ? 0.06 : 0.04) << d << " " << colour;
    }
  }
}

// Its own computation against the table of others, which is the mean of the three colours.
TEST(MieDroplets, AgreesWithTheTable) {
  for (const double d : {10.0, 20.0}) {
    const Image<float> table = mieDroplets(d);
    double worst = 0.0;
    for (const double deg :
         {0.3, 2.0, 5.0, 20.0, 60.0, 90.0, 120.0, 135.0, 139.0, 142.0, 150.0, 165.0, 175.0}) {
      const double mean = (at(table, deg, 0) + at(table, deg, 1) + at(table, deg, 2)) / 3.0;
      const double i = std::lround(deg / 180.0 * (kMieAngles - 1)) * kPi / (kMieAngles - 1);
      const double other = phaseMieDroplet(std::cos(i), d);
      worst = std::max(worst, std::abs(mean / other - 1.0));
      EXPECT_NEAR(mean, other, 0.2 * other) << d << " um at " << deg;
    }
    RecordProperty("worst", std::to_string(worst));
  }
}

// D. K. Lynch and S. N. Futterman 1991, "Ulloa's observations of the glory, fogbow, and an unidentified
// phenomenon": rings of the glory are red outside, and inversely as large as droplets.
TEST(MieDroplets, RingsAreColouredAndShrinkAsDropletsGrow) {
  double last = 0.0;
  for (const double d : {20.0, 14.0, 10.0}) {
    const Image<float> table = mieDroplets(d);
    const double guess = 180.0 - 28.0 / d;  // between the white middle and the first ring
    const double red = 180.0 - peakBetween(table, guess - 25.0 / d, guess, 0),
                 blue = 180.0 - peakBetween(table, guess - 25.0 / d, guess, 2);
    EXPECT_GT(red, 1.1 * blue) << d;
    EXPECT_GT(red, last) << d;
    last = red;
    EXPECT_GT(at(table, 180.0, 1), 1.3 * at(table, 170.0, 1)) << d;
  }
}

TEST(MieDroplets, FogbowIsRedOutsideAndWiderForSmallDroplets) {
  const Image<float> large = mieDroplets(40.0), small = mieDroplets(12.0);
  EXPECT_LT(peakBetween(large, 136.0, 150.0, 0), peakBetween(large, 136.0, 150.0, 2));  // red outside
  EXPECT_NEAR(peakBetween(large, 136.0, 150.0, 1), 140.0, 1.5);
  EXPECT_GT(peakBetween(small, 136.0, 155.0, 1), peakBetween(large, 136.0, 150.0, 1));
  EXPECT_GT(at(small, 144.0, 1), 1.5 * at(small, 125.0, 1));
}

TEST(MieDroplets, ClampsDiameters) {
  EXPECT_EQ(mieDroplets(80.0).data, mieDroplets(50.0).data);
  EXPECT_EQ(mieDroplets(0.5).data, mieDroplets(2.0).data);
}

}  // namespace
}  // namespace welkin::optics
