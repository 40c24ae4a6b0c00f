// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/ice_phase.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/optics/phase_integral.h"
#include "welkin/core/units.h"
#include "welkin/optics/phase.h"

namespace welkin::optics {
namespace {

constexpr int kRed = 0, kGreen = 1, kBlue = 2, kMean = 3;
// S. G. Warren and R. E. Brandt 2008, at 620, 550 and 460 nm.
constexpr double kIndex[] = {1.3088, 1.3110, 1.3151};

double angleOf(int i) {
  return 180.0 * i / (kIceAngles - 1);
}

double at(const Image<float>& phase, double deg, int channel) {
  return static_cast<double>(
      phase.at(static_cast<int>(std::lround(deg / 180.0 * (kIceAngles - 1))), 0, channel));
}

double brightest(const Image<float>& phase, double fromDeg, double toDeg, int channel) {
  double best = 0.0, where = 0.0;
  for (int i = 0; i < kIceAngles; ++i)
    if (angleOf(i) >= fromDeg && angleOf(i) <= toDeg && static_cast<double>(phase.at(i, 0, channel)) > best) {
      best = static_cast<double>(phase.at(i, 0, channel));
      where = angleOf(i);
    }
  return where;
}

// The least that a prism turns light by, degrees.
double leastTurn(double index, double prismDeg) {
  return 2.0 * degrees(std::asin(index * std::sin(radians(0.5 * prismDeg)))) - prismDeg;
}

TEST(IcePhase, IntegratesToOneInEachColour) {
  const Image<float> phase = icePhase();
  ASSERT_EQ(phase.width, kIceAngles);
  for (const int channel : {kRed, kGreen, kBlue, kMean}) {
    const PhaseIntegral sum = integralOf(phase, channel);
    EXPECT_NEAR(sum.whole, 1.0, 1e-3) << channel;
    EXPECT_NEAR(sum.forward, 0.752, 0.01) << channel;  // the two lobes': 0.753
  }
}

// Where least is turned most comes out; the sun's disc moves that outwards, by its radius, and what is seen
// of a colour's other wavelengths a little more.
TEST(IcePhase, HalosStandAtTheLeastTurn) {
  const Image<float> phase = icePhase();
  for (const int colour : {kRed, kGreen, kBlue}) {
    const double sharp = brightest(phase, 20.0, 26.0, colour) - leastTurn(kIndex[colour], 60.0);
    EXPECT_GT(sharp, 0.0) << colour;
    EXPECT_LT(sharp, 0.4) << colour;
    const double faint = brightest(phase, 45.5, 50.0, colour) - leastTurn(kIndex[colour], 90.0);
    EXPECT_GT(faint, -0.2) << colour;
    EXPECT_LT(faint, 1.0) << colour;
  }
  for (const double inner : {20.0, 45.5}) {
    EXPECT_LT(brightest(phase, inner, inner + 6.0, kRed), brightest(phase, inner, inner + 6.0, kGreen));
    EXPECT_LT(brightest(phase, inner, inner + 6.0, kGreen), brightest(phase, inner, inner + 6.0, kBlue));
  }
}

TEST(IcePhase, IsDarkInsideTheHaloAndRedAtItsEdge) {
  const Image<float> phase = icePhase();
  // P. Dandini et al. 2019, "Halo ratio from ground-based all-sky imaging": of 23 degrees over 20, above 1
  // where there is a halo.
  const double halo = at(phase, 23.0, kMean) / at(phase, 20.0, kMean);
  EXPECT_GT(halo, 1.05);
  EXPECT_LT(halo, 1.5);
  for (const int colour : {kRed, kGreen, kBlue}) {
    const double peak = at(phase, brightest(phase, 20.0, 26.0, colour), colour);
    EXPECT_GT(peak, 1.35 * at(phase, 21.0, colour)) << colour;
    EXPECT_GT(peak, 1.5 * at(phase, 26.0, colour)) << colour;
    const double faint = brightest(phase, 45.5, 50.0, colour);
    EXPECT_GT(at(phase, faint, colour), 1.1 * at(phase, faint - 1.0, colour)) << colour;
  }
  EXPECT_GT(at(phase, 21.9, kRed), 1.25 * at(phase, 21.9, kBlue));
  EXPECT_GT(at(phase, 23.0, kBlue), at(phase, 23.0, kRed));
}

// Away from halos it is much as the lobes that stand for light scattered more than once.
TEST(IcePhase, HasThePeakOfTheLobes) {
  const Image<float> phase = icePhase();
  for (const double deg : {0.0, 2.0, 5.0, 10.0})
    EXPECT_NEAR(
        at(phase, deg, kMean) / static_cast<double>(phaseIce(static_cast<float>(std::cos(radians(deg))))),
        1.0, 0.15)
        << deg;
}

}  // namespace
}  // namespace welkin::optics
