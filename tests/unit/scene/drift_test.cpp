// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/drift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/field/pattern_quantiles.h"
#include "welkin/scene/scene.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

constexpr std::uint64_t kSeeds[] = {1, 77, 123456789012345ull};
constexpr Drift kTurning{.windDeg = 120.0, .coverOktas = 0.0, .periodH = 2.0};

TEST(DriftNoise, IsSmoothBoundedAndNoughtAtNoughtAndOnAverage) {
  for (const std::uint64_t seed : kSeeds) {
    EXPECT_EQ(driftNoise(seed, 0.0), 0.0);
    constexpr int kSteps = 200;
    double sum = 0.0, most = 0.0;
    for (int i = 0; i < kDriftLoop * kSteps; ++i) {
      const double x = (i + 0.5) / kSteps, n = driftNoise(seed, x), d = 1e-4;
      sum += n;
      most = std::max(most, std::abs(n));
      // Differentiable: the slopes on both sides agree, on knots (x whole) too.
      const double at = static_cast<double>(i) / kSteps;
      const double left = (driftNoise(seed, at) - driftNoise(seed, at - d)) / d,
                   right = (driftNoise(seed, at + d) - driftNoise(seed, at)) / d;
      ASSERT_NEAR(left, right, 0.02) << at;
    }
    EXPECT_NEAR(sum / (kDriftLoop * kSteps), 0.0, 1e-6);
    EXPECT_LE(most, 1.0);
    EXPECT_GT(most, 0.4);  // it does something
    EXPECT_NEAR(driftNoise(seed, 3.3), driftNoise(seed, 3.3 + kDriftLoop), 1e-9);
    EXPECT_NEAR(driftNoise(seed, -0.7), driftNoise(seed, kDriftLoop - 0.7), 1e-9);
  }
  EXPECT_NE(driftNoise(1, 0.4), driftNoise(2, 0.4));
}

// Against a fine midpoint rule, forwards, backwards and past the end of the loop.
TEST(WindPath, IsTheIntegralOfTheWind) {
  for (const double hours : {0.3, 1.0, 5.7, 40.0, -3.2, 140.0}) {
    const double seconds = hours * 3600.0;
    constexpr int kSteps = 100000;
    glm::dvec2 sum(0.0);
    for (int i = 0; i < kSteps; ++i) {
      const double towards = radians(windFromDegAt(kTurning, 5, 200.0, (i + 0.5) / kSteps * seconds) + 180.0);
      sum += glm::dvec2(std::sin(towards), std::cos(towards)) * (seconds / kSteps);
    }
    const glm::dvec2 path = windPath(kTurning, 5, 200.0, seconds);
    EXPECT_NEAR(path.x, sum.x, 0.5) << hours;
    EXPECT_NEAR(path.y, sum.y, 0.5) << hours;
  }
}

TEST(WindPath, IsContinuousAndAsFastAsTheWind) {
  for (double t = -20000.0; t < 20000.0; t += 617.0) {
    const glm::dvec2 step = windPath(kTurning, 9, 90.0, t + 1.0) - windPath(kTurning, 9, 90.0, t);
    EXPECT_NEAR(glm::length(step), 1.0, 1e-3) << t;
  }
}

TEST(WindPath, WithoutDriftIsStraight) {
  const glm::dvec2 path = windPath({}, 9, 270.0, 100.0);
  EXPECT_NEAR(path.x, 100.0, 1e-9);
  EXPECT_NEAR(path.y, 0.0, 1e-9);
  EXPECT_EQ(windFromDegAt({}, 9, 33.0, 1e5), 33.0);
  EXPECT_EQ(oktasAt({}, 9, 3.0, 1e5), 3.0);
}

TEST(Drift, CoverStaysWithinTheSky) {
  const Drift d{.windDeg = 0.0, .coverOktas = 8.0, .periodH = 1.0};
  double least = 8.0, most = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double oktas = oktasAt(d, 3, 4.0, 100.0 * i);
    least = std::min(least, oktas);
    most = std::max(most, oktas);
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LE(most, 8.0);
  EXPECT_GT(most - least, 4.0);
}

// What is measured in the pattern is what the drift asks for then, and it never jumps.
TEST(Drift, CoverIsDelivered) {
  Sheet sheet;
  sheet.texels = 128;
  sheet.drift = {{.windDeg = 0.0, .coverOktas = 3.0, .periodH = 1.0}, 0, 11};
  for (const double oktas : {1.0, 4.0, 7.0}) {
    sheet.oktas = oktas;
    EXPECT_NEAR(8.0 * deliveredCover(sheet, 2), oktas, 0.01);  // at the scene's time exactly as described
    for (double t = 500.0; t < 40000.0; t += 3000.0) {
      const double wanted = oktasAt(sheet.drift.drift, 11, oktas, t);
      EXPECT_NEAR(8.0 * deliveredCover(sheet, 2, t), wanted, 0.03) << t;
      EXPECT_NEAR(8.0 * deliveredCover(sheet, 2, t + 1.0), 8.0 * deliveredCover(sheet, 2, t), 0.02);
    }
  }
  // The cutoff of a sheet without oktas has a cover of its own, about which it drifts.
  sheet.oktas.reset();
  const Sheet still = [&] {
    Sheet s = sheet;
    s.drift = {};
    return s;
  }();
  const double described = 8.0 * deliveredCover(still, 2);
  EXPECT_NEAR(8.0 * deliveredCover(sheet, 2), described, 0.01);
  const double t = 4000.0;
  EXPECT_NEAR(8.0 * deliveredCover(sheet, 2, t), oktasAt(sheet.drift.drift, 11, described, t), 0.05);
}

TEST(Drift, SheetsShareTheWindAndHaveTheirOwnCover) {
  Scene s;
  s.technique = Technique::kSkyPlane;
  s.sheets.resize(2);
  s.drift = {.windDeg = 20.0, .coverOktas = 2.0, .periodH = 3.0};
  const std::vector<Sheet> sheets = sheetsOf(s, {});
  EXPECT_EQ(sheets[0].drift.windSeed, sheets[1].drift.windSeed);
  EXPECT_NE(sheets[0].drift.coverSeed, sheets[1].drift.coverSeed);
  EXPECT_EQ(windPathM(sheets[0], 5000.0), windPathM(sheets[1], 5000.0));
  EXPECT_NE(windPathM(sheets[0], 5000.0), windPathM(s.sheets[0], 5000.0));
}

TEST(Drift, MovesVolumesAndIsReported) {
  Scene s = testing::cloudyScene(40.0, {weather::Genus::kStratocumulus});
  s.layers[0].windSpeedMps = 10.0;
  const auto drifted = [&](double seconds) { return windDriftM(s, weatherOf(s).layers[0], seconds); };
  const glm::dvec2 start = drifted(0.0), straight = drifted(7200.0);
  s.drift.windDeg = 90.0;
  EXPECT_EQ(drifted(0.0), start);
  field::CloudLayer moved = buildSky(s, 0.0).clouds->layers()[0];
  field::moveLayer(moved, drifted(7200.0));
  EXPECT_NEAR(glm::distance(moved.driftM, buildSky(s, 7200.0).clouds->layers()[0].driftM), 0.0f, 0.1f);
  const glm::dvec2 expected = start + 10.0 * windPath(s.drift, windSeed(s), s.layers[0].windFromDeg, 7200.0);
  EXPECT_NEAR(glm::distance(drifted(7200.0), expected), 0.0, 1.0);
  EXPECT_GT(glm::distance(straight, expected), 1000.0);

  s.technique = Technique::kSkyPlane;
  s.drift.coverOktas = 3.0;
  const SkyState later = buildSky(s, 5000.0);
  EXPECT_NE(later.cover[0].requestedOktas, 4.0);
  EXPECT_NEAR(later.cover[0].deliveredOktas, later.cover[0].requestedOktas, 0.05);
}

}  // namespace
}  // namespace welkin::scene
