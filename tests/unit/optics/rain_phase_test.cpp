// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/rain_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/unit/optics/phase_integral.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/optics/mie_sphere.h"

namespace welkin::optics {
namespace {

constexpr int kRed = 0, kGreen = 1, kBlue = 2;

double angleOf(int i) {
  return 180.0 * i / (kRainAngles - 1);
}

double meanBetween(const Image<float>& phase, double fromDeg, double toDeg, int colour) {
  double sum = 0.0, count = 0.0;
  for (int i = 0; i < kRainAngles; ++i)
    if (angleOf(i) >= fromDeg && angleOf(i) <= toDeg) {
      sum += static_cast<double>(phase.at(i, 0, colour));
      ++count;
    }
  return sum / count;
}

// How far from the point opposite to the sun a colour is brightest, between two such angles.
double brightest(const Image<float>& phase, double fromDeg, double toDeg, int colour) {
  int best = -1;
  for (int i = 0; i < kRainAngles; ++i) {
    const double out = 180.0 - angleOf(i);
    if (out >= fromDeg && out <= toDeg && (best < 0 || phase.at(i, 0, colour) > phase.at(best, 0, colour)))
      best = i;
  }
  return 180.0 - angleOf(best);
}

// R. Descartes 1637, "Les Météores": radius of the bow of rays reflected so often within a drop, degrees.
double descartes(double index, int reflections) {
  const double p = reflections + 1.0;
  const double incidence = std::acos(std::sqrt((index * index - 1.0) / (p * p - 1.0)));
  const double turned =
      2.0 * incidence - 2.0 * p * std::asin(std::sin(incidence) / index) + kPi * reflections;
  return std::abs(180.0 - degrees(turned));
}

TEST(RainPhase, IntegratesToOneInEachColour) {
  const Image<float> phase = rainPhase();
  ASSERT_EQ(phase.width, kRainAngles);
  for (const int colour : {kRed, kGreen, kBlue}) {
    const PhaseIntegral sum = integralOf(phase, colour);
    EXPECT_NEAR(sum.whole, 1.0, 5e-4) << colour;
    EXPECT_NEAR(sum.forward, 0.765, 0.01) << colour;
  }
}

TEST(RainPhase, BowsStandWhereRaysTurnBack) {
  const Image<float> phase = rainPhase();
  // Waves and the sun's disc move what is brightest from the rays' edge to the bright side.
  const double red = brightest(phase, 38.0, 46.0, kRed), blue = brightest(phase, 38.0, 46.0, kBlue);
  EXPECT_NEAR(red, descartes(1.3324, 1), 0.5);   // 650 nm
  EXPECT_NEAR(blue, descartes(1.3403, 1), 0.5);  // 450 nm
  EXPECT_LT(red, descartes(1.3324, 1));
  EXPECT_GT(red, blue + 0.7);
  const double redOutside = brightest(phase, 48.0, 57.0, kRed),
               blueOutside = brightest(phase, 48.0, 57.0, kBlue);
  EXPECT_NEAR(redOutside, descartes(1.3324, 2), 1.0);
  EXPECT_NEAR(blueOutside, descartes(1.3403, 2), 1.0);
  EXPECT_GT(redOutside, descartes(1.3324, 2));
  EXPECT_GT(blueOutside, redOutside + 1.2);  // the other way round
}

TEST(RainPhase, IsDarkBetweenTheBowsAndBrightInside) {
  const Image<float> phase = rainPhase();
  for (const int colour : {kRed, kGreen, kBlue}) {
    const double between = meanBetween(phase, 131.0, 136.5, colour),
                 inside = meanBetween(phase, 142.0, 150.0, colour),
                 outside = meanBetween(phase, 118.0, 126.0, colour);
    EXPECT_GT(inside, 10.0 * between) << colour;
    EXPECT_GT(outside, 1.8 * between) << colour;
    // The primary bow is some three times as bright as the secondary.
    const double primary = meanBetween(phase, 137.5, 140.0, colour) - inside,
                 secondary = meanBetween(phase, 126.0, 130.0, colour) - outside;
    EXPECT_GT(2.5 * primary, 5.0 * 4.0 * secondary / 3.0) << colour;
  }
}

// Against turns drawn one after the other, in rings of equal solid angle.
TEST(RainPhase, OfLightScatteredTwiceIsOneTurnAfterAnother) {
  const Image<float> phase = rainPhase();
  std::vector<double> upTo{0.0};  // share turned by less
  for (int i = 0; i + 1 < kRainAngles; ++i)
    upTo.push_back(upTo.back() + meanBetween(phase, angleOf(i) - 1e-3, angleOf(i + 1) + 1e-3, kGreen) *
                                     (std::cos(radians(angleOf(i))) - std::cos(radians(angleOf(i + 1)))));
  Random random(3);
  const auto chance = [&random] { return (static_cast<double>(random.next() >> 11) + 0.5) * 0x1p-53; };
  const auto turn = [&] {
    const auto above = std::upper_bound(upTo.begin(), upTo.end(), chance() * upTo.back());
    return radians(angleOf(static_cast<int>(above - upTo.begin()) - 1) + chance() * angleOf(1));
  };
  constexpr int kRings = 20, kPaths = 400000;
  std::vector<double> hits(kRings, 0.0);
  for (int k = 0; k < kPaths; ++k) {
    const double a = turn(), b = turn();
    const double c = std::cos(a) * std::cos(b) + std::sin(a) * std::sin(b) * std::cos(2.0 * kPi * chance());
    ++hits[static_cast<std::size_t>(std::clamp((1.0 - c) / 2.0 * kRings, 0.0, kRings - 1.0))];
  }
  for (int r = 0; r < kRings; ++r) {
    const double drawn = hits[static_cast<std::size_t>(r)] * kRings / (4.0 * kPi * kPaths);
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < kRainAngles; ++i) {
      const double a = radians(angleOf(i)), at = (1.0 - std::cos(a)) / 2.0 * kRings;
      if (at < r || at >= r + 1) continue;
      sum += std::sin(a) * static_cast<double>(phase.at(i, 0, 3));
      weight += std::sin(a);
    }
    const double hitsHere = hits[static_cast<std::size_t>(r)];
    EXPECT_NEAR(sum / weight, drawn, drawn * (0.03 + 4.0 / std::sqrt(hitsHere))) << r;
  }
}

// Away from the bows drops of all sizes scatter alike: Mie's sums as the table has them, by themselves, with
// the rings of a few drops of some tenths of a millimetre evened out.
TEST(RainPhase, IsMiesTheoryWhereSizeMattersNot) {
  std::vector<double> intensity(2049, 0.0);
  constexpr int kDrops = 24;
  for (int k = 0; k < kDrops; ++k) {
    const double x = 1000.0 + 21.37 * k;
    addMieSphere(x, 1.3345, 1.0 / (4.0 * kPi * x * x * kDrops), intensity);
  }
  const Image<float> phase = rainPhase();
  for (const double deg : {20.0, 40.0, 60.0, 100.0, 150.0}) {
    double mie = 0.0, count = 0.0;
    for (int i = 0; i < kRainAngles; ++i)
      if (std::abs(angleOf(i) - deg) < 2.0) {
        mie += intensity[static_cast<std::size_t>(i)];
        ++count;
      }
    const double table = meanBetween(phase, deg - 2.0, deg + 2.0, kGreen);
    EXPECT_NEAR(table, mie / count, 0.06 * table) << deg;
  }
}

}  // namespace
}  // namespace welkin::optics
