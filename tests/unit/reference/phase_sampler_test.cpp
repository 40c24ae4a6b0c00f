// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/phase_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "welkin/core/units.h"
#include "welkin/optics/mie_phase.h"
#include "welkin/optics/phase.h"

namespace welkin::reference {
namespace {

PhaseSampler droplets() {
  const auto fit = optics::dropletPhase(20.0f);
  return PhaseSampler::tabulated(
      [fit](double c) { return optics::phaseDroplet(static_cast<float>(c), fit); });
}

// Even steps of u must give cosines whose histogram is the density.
void expectSamplesFollowDensity(const PhaseSampler& s, double expectedMean, double tolerance) {
  constexpr int kSamples = 400000;
  constexpr std::array kEdges = {-1.0, -0.8, -0.3, 0.2, 0.7, 0.95, 0.999, 1.0};
  std::array<double, kEdges.size() - 1> sampled{}, integrated{};
  double mean = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double c = s.sampleCosine((i + 0.5) / kSamples);
    mean += c / kSamples;
    std::size_t bin = 0;
    while (bin + 1 < sampled.size() && c >= kEdges[bin + 1]) ++bin;
    sampled[bin] += 1.0 / kSamples;
  }
  for (std::size_t b = 0; b < sampled.size(); ++b) {
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
      const double width = (kEdges[b + 1] - kEdges[b]) / kSteps;
      integrated[b] += 2.0 * kPi * s.density(kEdges[b] + (i + 0.5) * width) * width;
    }
    EXPECT_NEAR(sampled[b], integrated[b], 2e-4) << "from cosine " << kEdges[b];
  }
  EXPECT_NEAR(mean, expectedMean, tolerance);
  EXPECT_NEAR(mean, s.meanCosine(), 1e-4);
}

TEST(PhaseSampler, SamplesFollowTheDensity) {
  for (const double g : {-0.5, 0.0, 0.00005, 0.75, 0.9})
    expectSamplesFollowDensity(PhaseSampler::henyeyGreenstein(g), g, 1e-4);
  expectSamplesFollowDensity(
      PhaseSampler::tabulated([](double c) { return optics::phaseRayleigh(static_cast<float>(c)); }), 0.0,
      1e-4);
  const auto mie = [](double c) { return optics::phaseMieDroplet(c, 10.0); };
  expectSamplesFollowDensity(PhaseSampler::tabulated(mie), 0.85, 0.005);
  expectSamplesFollowDensity(droplets(), optics::dropletMeanCosine(optics::dropletPhase(20.0f)), 1e-3);
}

TEST(PhaseSampler, TablesAreNearTheirFunction) {
  const auto fit = optics::dropletPhase(20.0f);
  const PhaseSampler s = droplets();
  for (const double deg : {1.0, 5.0, 30.0, 90.0, 142.0, 179.0}) {
    const double c = std::cos(deg * kPi / 180.0), f = optics::phaseDroplet(static_cast<float>(c), fit);
    EXPECT_NEAR(s.density(c), f, 0.02 * f) << deg << " degrees";
  }
}

// What is left of a function beside its peak is nowhere negative nor above the level.
TEST(PhaseSampler, ThePeakLeavesAtMostALevel) {
  const optics::DropletPhase fit = optics::dropletPhase(16.0f);
  const PhaseSampler all = PhaseSampler::tabulated(
      [&](double c) { return static_cast<double>(optics::phaseDroplet(static_cast<float>(c), fit)); });
  constexpr double kLevel = 0.3;
  const PhaseSampler peak = all.above(kLevel);
  EXPECT_GT(peak.integral(), 0.3);
  EXPECT_LT(peak.integral(), 0.9);
  int steep = 0;
  for (int i = 0; i <= 20000; ++i) {
    const double angle = kPi * i / 20000.0 * i / 20000.0, c = std::cos(angle);
    const double rest = all.density(c) - peak.integral() * peak.density(c);
    EXPECT_GE(rest, -1e-7 * all.density(c));
    EXPECT_LE(rest, kLevel + 2e-7 * all.density(c));
    if (all.density(c) > 100.0 * kLevel) ++steep;
  }
  EXPECT_GT(steep, 100);
}

}  // namespace
}  // namespace welkin::reference
