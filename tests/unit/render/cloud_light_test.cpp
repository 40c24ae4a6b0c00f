// SPDX-License-Identifier: Apache-2.0
// shaders/lib/cloud_light.glsl against what is known of light in clouds. docs/theory.md has the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"

namespace welkin::render {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/phase.glsl"
// After the phase functions that it calls.
#include "shaders/lib/cloud_light.glsl"

constexpr float kDepths[] = {0.0f, 1e-4f, 0.03f, 0.5f, 3.0f, 20.0f, 150.0f, 2000.0f};

// In light that is the same from above and below a cloud that absorbs nothing cannot be seen.
TEST(CloudLight, VanishesInAWhiteFurnace) {
  for (const float up : kDepths)
    for (const float down : kDepths) {
      const vec2 shares = cloudSkyShares({up, down, up, down});
      EXPECT_NEAR(shares.x + shares.y, 1.0f, 1e-6f) << up << " " << down;
      EXPECT_GE(shares.x, 0.0f);
      EXPECT_GE(shares.y, 0.0f);
    }
}

// What is more on one side is less on the other, and never as much as there is of the even light: twice the
// tilt times half of that light is what the splats add to it.
TEST(CloudLight, ATiltIsTheOppositeFromTheOtherSide) {
  for (const float towards : kDepths)
    for (const float away : kDepths)
      for (const float c : {-1.0f, -0.3f, 0.0f, 0.8f, 1.0f}) {
        const float tilt = cloudTilt(towards, away, c);
        EXPECT_NEAR(tilt, -cloudTilt(away, towards, -c), 1e-6f);
        EXPECT_LE(std::abs(tilt), 1.0f);
      }
  EXPECT_GT(cloudTilt(0.0f, 50.0f, 0.0f), 0.2f);
  EXPECT_EQ(cloudTilt(7.0f, 7.0f, 0.0f), 0.0f);
}

TEST(CloudLight, MoreCloudAboveLetsLessSkyThrough) {
  float last = 1.0f;
  for (const float up : kDepths) {
    const float share = cloudSkyShares({up, 5.0f, up, 5.0f}).x;
    EXPECT_LE(share, last);
    last = share;
  }
  EXPECT_LT(last, 0.02f);
}

// Across the line to the sun, or level, a view has as much of what lies before as of what lies behind: no
// edge in the light of even fog, whichever way one turns.
TEST(CloudLight, TurningDoesNotChangeAtOnceHowMuchCloudIsAhead) {
  const CloudDepths depths{40.0f, 4.0f, 14.0f, 1.5f};
  constexpr float kStep = 1e-3f;
  for (const float other : {0.0f, 0.05f, 0.4f})
    for (float x = -1.0f; x < 1.0f; x += kStep) {
      const float cosSun = cloudDepthAhead(depths, x + kStep, other, 1.0f) /
                           cloudDepthAhead(depths, x, other, 1.0f),
                  height = cloudDepthAhead(depths, other, x + kStep, 1.0f) /
                           cloudDepthAhead(depths, other, x, 1.0f);
      ASSERT_NEAR(cosSun, 1.0f, 0.02f) << x << " " << other;
      ASSERT_NEAR(height, 1.0f, 0.02f) << x << " " << other;
    }
  EXPECT_NEAR(cloudDepthAhead(depths, 1.0f, 0.0f, 1.0f), depths.toSun, 0.1f * depths.toSun);
  EXPECT_NEAR(cloudDepthAhead(depths, 0.0f, -1.0f, 1.0f), depths.down, 0.1f * depths.down);
}

TEST(CloudLight, IsPositiveAndFiniteWhereverTheSunIs) {
  for (const float toSun : kDepths)
    for (const float fromSun : kDepths)
      for (const float up : kDepths)
        for (const float sunHeight : {-1.0f, -0.05f, 0.0f, 0.01f, 0.3f, 1.0f})
          for (const float c : {-1.0f, -0.5f, 0.0f, 0.9f, 1.0f}) {
            const float viewHeight = c * sunHeight;
            const float source = cloudSunSource({toSun, fromSun, up, 1.0f}, phaseHenyeyGreenstein(c, 0.85f),
                                                c, viewHeight, sunHeight);
            ASSERT_TRUE(std::isfinite(source) && source >= 0.0f)
                << toSun << " " << fromSun << " " << up << " " << sunHeight;
          }
}

// What it is compared with: over all directions each octave sends out the light that its extinction leaves.
TEST(CloudLight, OctavesAreHalvesOfHalves) {
  const CloudDepths clear{0.0f, 0.0f, 0.0f, 0.0f}, deep{6.0f, 6.0f, 6.0f, 6.0f};
  EXPECT_EQ(cloudSunSourceSingle(clear, 0.3f), 0.3f);
  EXPECT_NEAR(cloudSunSourceSingle(deep, 0.3f), 0.3f * std::exp(-6.0f), 1e-7f);
  for (const CloudDepths& d : {clear, deep}) {
    double sum = 0.0, wanted = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const auto c = static_cast<float>(-1.0 + 2.0 * (i + 0.5) / kSteps);
      sum += 4.0 * kPi / kSteps *
             static_cast<double>(cloudSunSourceOctaves(d, phaseHenyeyGreenstein(c, kDropletAsymmetry), c));
    }
    for (int i = 0; i < 8; ++i)
      wanted += std::pow(0.5, i) * std::exp(-std::pow(0.5, i) * static_cast<double>(d.toSun));
    EXPECT_NEAR(sum, wanted, 1e-3 * wanted);
  }
}

// A wisp: the light scattered once, and of the rest what is proportional to the depth.
TEST(CloudLight, ThinCloudScattersOnce) {
  for (const float c : {-1.0f, 0.0f, 0.7f, 1.0f}) {
    const float phase = phaseHenyeyGreenstein(c, 0.85f);
    const float none = cloudSunSource({0.0f, 0.0f, 0.0f, 0.0f}, phase, c, c, 1.0f);
    EXPECT_NEAR(none, phase, 1e-6f + 1e-5f * phase) << c;
    const float wisp = cloudSunSource({1e-3f, 1e-3f, 1e-3f, 1e-3f}, phase, c, c, 1.0f);
    EXPECT_NEAR(wisp, phase, 2e-3f * phase + 1e-3f) << c;
  }
}

// Light turned by peaks alone is the sum over its orders, each by Poisson's law along the line to the sun.
TEST(CloudLight, PeaksAreTheSumOfTheirOrders) {
  for (const PhasePeak peak : {PhasePeak{0.45f, 0.994f}, PhasePeak{0.55f, 0.92f}})
    for (const float toSun : {0.1f, 1.0f, 3.0f})
      for (const double degrees : {0.5, 2.0, 8.0, 30.0}) {
        const auto c = static_cast<float>(std::cos(degrees * kPi / 180.0));
        double wanted = 0.0, chance = std::exp(-static_cast<double>(toSun)), turned = 1.0;
        for (int order = 1; order < 30; ++order) {
          turned *= static_cast<double>(peak.share);
          if (order > 1)
            wanted +=
                turned * chance *
                static_cast<double>(phaseHenyeyGreenstein(c, std::pow(peak.g, static_cast<float>(order))));
          chance *= static_cast<double>(toSun) / order;
        }
        EXPECT_NEAR(static_cast<double>(cloudPeakSource(toSun, c, peak)) / wanted, 1.0, 0.25)
            << peak.g << " " << toSun << " " << degrees;
      }
}

// Below the depth at which the sun's beam is spent, light only becomes less on its way to the dark side.
TEST(CloudLight, LightDecaysTowardsTheDarkSide) {
  float last = 1e9f;
  for (const float t : {16.0f, 32.0f, 48.0f, 60.0f, 63.0f}) {
    const float source =
        cloudSunSource({t, 64.0f - t, t, 64.0f - t}, phaseHenyeyGreenstein(-0.5f, 0.85f), -0.5f, -0.5f, 1.0f);
    EXPECT_LT(source, last) << t;
    last = source;
  }
}

// --- slabs
// -----------------------------------------------------------------------------------------------------------------------

constexpr double kG = 0.85;

// Radiance that leaves a slab of optical depth `tau`, for unit illuminance of a plane facing the sun; mu:
// cosine between the way of the light and the vertical, > 0 out of the top, < 0 out of the bottom; phi:
// azimuth from the sun's.
double leaving(double tau, double mu0, double mu, double phi) {
  const double across = std::sqrt(std::max(0.0, 1.0 - mu * mu)) * std::sqrt(std::max(0.0, 1.0 - mu0 * mu0));
  // The eye looks against the light: its direction of view is (-mu, ...) and the sun stands at (+mu0, ...).
  const float cosSun = static_cast<float>(-mu * mu0 + across * std::cos(phi));
  const float phase = phaseHenyeyGreenstein(cosSun, static_cast<float>(kG));
  // Midpoints in the depth from the side that the light leaves by, finer there.
  constexpr int kSteps = 64;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const auto edge = [&](double x) { return tau * x * x * x; };
    const double x = (i + 0.5) / kSteps, from = edge(x);
    const double width = edge(x + 0.5 / kSteps) - edge(x - 0.5 / kSteps);
    const double above = mu > 0.0 ? from : tau - from, below = tau - above;
    const CloudDepths depths{static_cast<float>(above / mu0), static_cast<float>(below / mu0),
                             static_cast<float>(above), static_cast<float>(below)};
    sum += cloudSunSource(depths, phase, cosSun, static_cast<float>(-mu), static_cast<float>(mu0)) *
           std::exp(-from / std::abs(mu)) * width / std::abs(mu);
  }
  return sum;
}

// Flux through the top (side 1) or the bottom (side -1) as a share of what falls in.
double leavingFlux(double tau, double mu0, double side) {
  constexpr int kMu = 48, kPhi = 48;
  double sum = 0.0;
  for (int i = 0; i < kMu; ++i) {
    // Finer towards the vertical, where the forward peak leaves.
    const double y = (i + 0.5) / kMu, mu = 1.0 - y * y, dMu = 2.0 * y / kMu;
    for (int j = 0; j < kPhi; ++j) {
      const double z = (j + 0.5) / kPhi, phi = kPi * z * z, dPhi = 2.0 * kPi * z / kPhi;
      sum += 2.0 * leaving(tau, mu0, side * mu, phi) * mu * dMu * dPhi;
    }
  }
  return sum / mu0;
}

// Converged discrete ordinates for Henyey-Greenstein scattering, g = 0.85, nothing absorbed, black ground:
// albedo, and radiance to the nadir as pi I / (mu0 F). Transmittance is what albedo leaves.
struct Slab {
  double tau, mu0, albedo, nadir;
};
constexpr Slab kSlabs[] = {
    {1, 1, 0.0423162, 0.0176279},    {4, 1, 0.1909149, 0.1316950},    {16, 1, 0.5572094, 0.5654561},
    {64, 1, 0.8462810, 0.9329113},   {1, 0.5, 0.1648776, 0.0548350},  {4, 0.5, 0.4160225, 0.2300100},
    {16, 0.5, 0.6974049, 0.5599460}, {64, 0.5, 0.8949697, 0.8110817},
};

TEST(CloudLight, SlabsAgreeWithDiscreteOrdinates) {
  std::vector<double> errors;
  std::printf(
      "| optical depth | sun at | albedo | exact | transmittance | exact | radiance to the nadir | exact "
      "|\n");
  for (const Slab& slab : kSlabs) {
    const double albedo = leavingFlux(slab.tau, slab.mu0, 1.0);
    const double transmittance = std::exp(-slab.tau / slab.mu0) + leavingFlux(slab.tau, slab.mu0, -1.0);
    const double nadir = kPi * leaving(slab.tau, slab.mu0, 1.0, 0.0) / slab.mu0;
    std::printf("| %g | %g | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f |\n", slab.tau,
                std::round(std::asin(slab.mu0) * 180 / kPi), albedo, slab.albedo, transmittance,
                1.0 - slab.albedo, nadir, slab.nadir);
    errors.push_back(std::abs(albedo / slab.albedo - 1.0));
    errors.push_back(std::abs(transmittance / (1.0 - slab.albedo) - 1.0));
    errors.push_back(std::abs(nadir / slab.nadir - 1.0));
  }
  std::sort(errors.begin(), errors.end());
  const double median = 0.5 * (errors[errors.size() / 2 - 1] + errors[errors.size() / 2]);
  std::printf("relative error: median %.3f, worst %.3f\n", median, errors.back());
  EXPECT_LE(median, 0.15);
  EXPECT_LE(errors.back(), 0.40);
}

}  // namespace
}  // namespace welkin::render
