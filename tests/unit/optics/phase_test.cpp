// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/phase.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "welkin/core/units.h"

namespace welkin::optics {
namespace {

// Integrals over the sphere of p and of p times the cosine. Midpoints in the angle, squeezed towards 0 where
// peaks are.
struct Moments {
  double norm = 0.0, meanCosine = 0.0;
};
Moments moments(const std::function<double(float)>& p) {
  constexpr int kSteps = 40000;
  Moments m;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps, angle = kPi * x * x * x;
    const double dOmega = 2.0 * kPi * std::sin(angle) * kPi * 3.0 * x * x / kSteps;
    const double value = p(static_cast<float>(std::cos(angle))) * dOmega;
    m.norm += value;
    m.meanCosine += value * std::cos(angle);
  }
  return m;
}

TEST(Phase, RayleighIsNormalisedAndBalanced) {
  const Moments m = moments(phaseRayleigh);
  EXPECT_NEAR(m.norm, 1.0, 1e-5);
  EXPECT_NEAR(m.meanCosine, 0.0, 1e-5);
}

TEST(Phase, HenyeyGreensteinHasItsMeanCosine) {
  for (float g : {-0.5f, 0.0f, 0.3f, 0.76f, 0.95f}) {
    const Moments m = moments([g](float c) { return phaseHenyeyGreenstein(c, g); });
    EXPECT_NEAR(m.norm, 1.0, 2e-4) << g;
    EXPECT_NEAR(m.meanCosine, g, 2e-4) << g;
  }
}

TEST(Phase, DraineHasItsMeanCosine) {
  for (float g : {0.0f, 0.4f, 0.8f}) {
    for (float alpha : {0.0f, 1.0f, 20.0f}) {
      const Moments m = moments([=](float c) { return phaseDraine(c, g, alpha); });
      EXPECT_NEAR(m.norm, 1.0, 2e-4) << g << " " << alpha;
      EXPECT_NEAR(m.meanCosine, draineMeanCosine(g, alpha), 2e-4) << g << " " << alpha;
    }
  }
}

TEST(Phase, DraineBecomesRayleigh) {
  for (float c : {-1.0f, -0.2f, 0.7f}) EXPECT_NEAR(phaseDraine(c, 0.0f, 1.0f), phaseRayleigh(c), 1e-7f);
}

TEST(Phase, HazeHasItsMeanCosine) {
  for (float g : {0.4f, 0.56f, 0.8f}) {
    const Moments m = moments([g](float c) { return phaseHaze(c, g); });
    EXPECT_NEAR(m.norm, 1.0, 2e-4) << g;
    EXPECT_NEAR(m.meanCosine, g, 2e-4) << g;
  }
}

TEST(Phase, IceScattersAllOnce) {
  const Moments m = moments([](float c) { return phaseIce(c); });
  EXPECT_NEAR(m.norm, 1.0, 2e-4);
  EXPECT_NEAR(m.meanCosine, 0.55 * 0.92 + 0.45 * 0.55, 2e-4);
}

TEST(Phase, DropletsHaveTheirMeanCosine) {
  for (float d : {5.0f, 10.0f, 20.0f, 50.0f}) {
    const DropletPhase p = dropletPhase(d);
    const Moments m = moments([&](float c) { return phaseDroplet(c, p); });
    EXPECT_NEAR(m.norm, 1.0, 5e-3) << d;  // single precision in a peak of 1e5
    EXPECT_NEAR(m.meanCosine, dropletMeanCosine(p), 5e-3) << d;
  }
  // Mie theory for water: mean cosines by diameter.
  EXPECT_NEAR(dropletMeanCosine(dropletPhase(5.0f)), 0.843, 0.02);
  EXPECT_NEAR(dropletMeanCosine(dropletPhase(10.0f)), 0.864, 0.02);
  EXPECT_NEAR(dropletMeanCosine(dropletPhase(20.0f)), 0.879, 0.02);
  EXPECT_NEAR(dropletMeanCosine(dropletPhase(50.0f)), 0.891, 0.02);
}

TEST(Phase, DropletDiameterIsClamped) {
  EXPECT_EQ(dropletPhase(1.0f).gHg, dropletPhase(5.0f).gHg);
  EXPECT_EQ(dropletPhase(500.0f).wDraine, dropletPhase(50.0f).wDraine);
}

// The fit against Mie theory (tests/data/optics, polydisperse water droplets) where it claims to be good: on
// average over 5 to 60 degrees within 12 %, nowhere off by more than a factor 1.6.
TEST(Phase, DropletsFollowMieForward) {
  std::ifstream file(WELKIN_TEST_DATA_DIR "/optics/mie_water_phase_polydisperse.tsv");
  ASSERT_TRUE(file);
  constexpr std::array<float, 5> kDiametersUm = {5, 8, 10, 15, 20};
  std::array<double, 5> sumLog{};
  int rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream in(line);
    double angleDeg = 0.0;
    in >> angleDeg;
    if (angleDeg < 5.0 || angleDeg > 60.0) continue;
    ++rows;
    for (std::size_t i = 0; i < kDiametersUm.size(); ++i) {
      double mie = 0.0;
      in >> mie;
      ASSERT_TRUE(in) << line;
      const double fit =
          phaseDroplet(static_cast<float>(std::cos(radians(angleDeg))), dropletPhase(kDiametersUm[i]));
      EXPECT_LT(std::abs(std::log(fit / mie)), std::log(1.9))
          << angleDeg << " degrees, " << kDiametersUm[i] << " um";
      sumLog[i] += std::log(fit / mie);
    }
  }
  ASSERT_GT(rows, 20);
  for (std::size_t i = 0; i < kDiametersUm.size(); ++i) {
    EXPECT_NEAR(sumLog[i] / rows, 0.0, 0.15) << kDiametersUm[i] << " um";
  }
}

}  // namespace
}  // namespace welkin::optics
