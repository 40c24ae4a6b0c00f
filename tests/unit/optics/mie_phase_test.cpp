// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/mie_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "welkin/core/units.h"

namespace welkin::optics {
namespace {

constexpr std::array kDiametersUm = {5.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0};

TEST(MiePhase, IsTheTable) {
  std::ifstream file(WELKIN_TEST_DATA_DIR "/optics/mie_water_phase_polydisperse.tsv");
  std::string line;
  int rows = 0;
  while (std::getline(file, line)) {
    if (line.starts_with("#")) continue;
    std::istringstream in(line);
    double angle = 0.0;
    in >> angle;
    ++rows;
    for (const double d : kDiametersUm) {
      double mie = 0.0;
      in >> mie;
      EXPECT_NEAR(phaseMieDroplet(std::cos(angle * kPi / 180.0), d), mie, 1e-6 * mie) << angle << " " << d;
    }
  }
  EXPECT_EQ(rows, 195);
}

struct Moments {
  double norm = 0.0, meanCosine = 0.0;
};
Moments momentsOf(double diameterUm) {
  constexpr int kSteps = 20000;
  Moments m;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps, angle = kPi * x * x;
    const double dOmega = 2.0 * kPi * std::sin(angle) * 2.0 * kPi * x / kSteps;
    const double p = phaseMieDroplet(std::cos(angle), diameterUm) * dOmega;
    m.norm += p;
    m.meanCosine += p * std::cos(angle);
  }
  m.meanCosine /= m.norm;
  return m;
}

TEST(MiePhase, IsNormalisedAndLooksAheadTheMoreTheLarger) {
  double last = 0.82;
  for (const double d : {5.0, 8.0, 10.0, 15.0, 20.0}) {
    const Moments m = momentsOf(d);
    EXPECT_NEAR(m.norm, 1.0, 0.02) << d;
    EXPECT_GT(m.meanCosine, last) << d;
    last = m.meanCosine;
  }
  EXPECT_LT(last, 0.88);
  // D. Deirmendjian's cloud C.1 (1969), whose droplets measure 8 um most often and 12 in effect.
  EXPECT_NEAR(momentsOf(10.0).meanCosine, 0.848, 0.01);
}

// What the fit does not have: the fogbow is brighter than what lies beside it, and so is the glory.
TEST(MiePhase, HasFogbowAndGlory) {
  const auto at = [](double deg) { return phaseMieDroplet(std::cos(deg * kPi / 180.0), 20.0); };
  EXPECT_GT(at(142.0), 1.5 * at(125.0));
  EXPECT_GT(at(180.0), 1.3 * at(170.0));
}

TEST(MiePhase, LiesBetweenItsNeighbours) {
  const double c = std::cos(142.0 * kPi / 180.0);
  const double a = phaseMieDroplet(c, 10.0), b = phaseMieDroplet(c, 15.0), between = phaseMieDroplet(c, 12.0);
  EXPECT_GT(between, std::min(a, b));
  EXPECT_LT(between, std::max(a, b));
  EXPECT_EQ(phaseMieDroplet(c, 100.0), phaseMieDroplet(c, 40.0));
}

}  // namespace
}  // namespace welkin::optics
