// SPDX-License-Identifier: Apache-2.0
// Skies filled with clouds of metaballs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/testing/skies.h"
#include "welkin/core/parallel.h"
#include "welkin/scene/cumulus_library.h"
#include "welkin/scene/metaball_layer.h"
#include "welkin/scene/metaballs.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

Scene heaps(double oktas) {
  Scene s = testing::cloudyScene(50.0, {weather::Genus::kCumulus}, oktas);
  s.technique = Technique::kMetaballs;
  return s;
}

CloudBalls ballsOf(const SkyState& state, double secondsAfter) {
  CloudBalls balls;
  state.metaballs->at(secondsAfter, {0.0, 0.0, 2.0}, state.clouds->earthRadiusM(), balls);
  return balls;
}

// What there is of a cloud in the box that its map was of.
double within(const std::vector<field::Metaball>& balls, double height) {
  const field::MetaballField density(balls);
  constexpr int kSteps = 40;
  double sum = 0.0;
  for (int z = 0; z < kSteps; ++z)
    for (int y = 0; y < kSteps; ++y)
      for (int x = 0; x < kSteps; ++x)
        sum += density({(x + 0.5) / kSteps - 0.5, (y + 0.5) / kSteps - 0.5, height * (z + 0.5) / kSteps});
  return sum * height / (kSteps * kSteps * kSteps);
}

// All levels hold the same cloud. (Balls of the coarser ones reach out of the box, where no map holds them.)
TEST(CumulusLibrary, LevelsAreTheSameCloud) {
  for (const auto* family : {&cumulusTowers(), &flatCumulus()})
    for (const LibraryCloud& cloud : *family) {
      EXPECT_LT(cloud.levels[0].size(), cloud.levels[1].size());
      EXPECT_LT(cloud.levels[1].size(), cloud.levels[2].size());
      const double finest = within(cloud.levels.back(), cloud.height);
      EXPECT_GT(finest, 0.05);
      for (const auto& level : cloud.levels) EXPECT_NEAR(within(level, cloud.height) / finest, 1.0, 0.15);
    }
}

// Little of a cloud hangs below its base.
TEST(CumulusLibrary, BasesAreFlat) {
  for (const auto* family : {&cumulusTowers(), &flatCumulus()})
    for (const LibraryCloud& cloud : *family) {
      std::vector<field::Metaball> lower = cloud.levels.back();
      for (field::Metaball& b : lower) b.centreM.z += 0.04 + cloud.height;
      EXPECT_LT(within(lower, cloud.height), 0.03 * within(cloud.levels.back(), cloud.height));
    }
}

TEST(MetaballLayer, DeliversTheCoverAskedFor) {
  for (const double oktas : {1.0, 3.0, 6.0}) {
    const SkyState state = buildSky(heaps(oktas), 0.0);
    EXPECT_NEAR(state.cover.at(0).deliveredOktas, oktas, 0.4);
    EXPECT_EQ(state.cover.at(0).requestedOktas, oktas);
  }
  EXPECT_TRUE(ballsOf(buildSky(heaps(0.0), 0.0), 0.0).balls.empty());
}

// Clouds stand in groups and differ in size: were each anywhere by itself, numbers in equal squares would
// vary as much as they are large, and of a lattice less.
TEST(MetaballLayer, CloudsStandInGroups) {
  const SkyState state = buildSky(heaps(3.0), 0.0);
  const MetaballLayer layer(state.weather.layers[0], 5, state.clouds->earthRadiusM());
  std::vector<MetaballLayer::Cloud> clouds;
  layer.cloudsAt(0.0, glm::dvec2(0.0), glm::dvec2(0.0), clouds);
  double widest = 0.0, sum = 0.0, squares = 0.0;
  for (const auto& cloud : clouds) {
    widest = std::max(widest, cloud.widthM);
    sum += cloud.widthM, squares += cloud.widthM * cloud.widthM;
  }
  const auto all = static_cast<double>(clouds.size());
  EXPECT_GT(squares * all / (sum * sum), 1.15);
  constexpr int kSide = 24;
  std::vector<double> inSquare(kSide * kSide);
  for (const auto& cloud : clouds) {
    const glm::dvec2 at = glm::floor(glm::dvec2(cloud.baseM) / widest) + 0.5 * kSide;
    if (at.x >= 0.0 && at.y >= 0.0 && at.x < kSide && at.y < kSide)
      inSquare[static_cast<std::size_t>(at.y * kSide + at.x)] += 1.0;
  }
  double number = 0.0, numberSquares = 0.0;
  for (const double n : inSquare) number += n, numberSquares += n * n;
  const double mean = number / (kSide * kSide);
  EXPECT_GT((numberSquares / (kSide * kSide) - mean * mean) / mean, 1.2);
}

// Where grown-up clouds in all cells are too few, they become larger and stand closer.
TEST(MetaballLayer, CoversTheWholeSky) {
  for (const auto genus :
       {weather::Genus::kCumulus, weather::Genus::kStratocumulus, weather::Genus::kCumulonimbus})
    for (const double oktas : {7.0, 8.0}) {
      Scene s = testing::cloudyScene(50.0, {genus}, oktas);
      s.technique = Technique::kMetaballs;
      const SkyState state = buildSky(s, 0.0);
      EXPECT_NEAR(state.cover.at(0).deliveredOktas, oktas, 0.4) << static_cast<int>(genus);
      EXPECT_TRUE(state.warnings.empty());
    }
}

TEST(MetaballLayer, SaysWhatItCannotCover) {
  Scene s = heaps(8.0);
  s.layers[0].baseM = 2400.0;
  s.layers[0].topM = 2500.0;
  const SkyState state = buildSky(s, 0.0);
  EXPECT_LT(state.cover.at(0).deliveredOktas, 7.6);
  ASSERT_EQ(state.warnings.size(), 1u);
  EXPECT_NE(state.warnings[0].find("the cumulus from 2400 to 2500 m covers"), std::string::npos)
      << state.warnings[0];
  EXPECT_NE(state.warnings[0].find("and not 8"), std::string::npos);
}

// Clouds come and go and drift, and the sky stays as cloudy on the whole; any instant is found without
// others.
TEST(MetaballLayer, IsAPureFunctionOfTime) {
  const SkyState state = buildSky(heaps(3.0), 0.0);
  const SkyState other = buildSky(heaps(3.0), 900.0);
  const CloudBalls now = ballsOf(state, 0.0), later = ballsOf(state, 900.0);
  EXPECT_EQ(later.balls, ballsOf(other, 900.0).balls);
  EXPECT_NE(now.balls, later.balls);
  EXPECT_NEAR(static_cast<double>(later.clouds.size()) / static_cast<double>(now.clouds.size()), 1.0, 0.15);
  EXPECT_NEAR(other.cover.at(0).deliveredOktas, 3.0, 1.5);
}

// Near clouds are balls and far ones pictures, those between both, the more a picture the farther; who asks
// for balls alone has the same clouds.
TEST(MetaballLayer, FarCloudsArePictures) {
  const SkyState state = buildSky(heaps(3.0), 0.0);
  const glm::dvec3 eyeM(3000.0, -2000.0, 700.0);
  CloudBalls seen, again, all;
  state.metaballs->at(60.0, eyeM, state.clouds->earthRadiusM(), seen);
  state.metaballs->at(60.0, eyeM, state.clouds->earthRadiusM(), again);
  state.metaballs->at(60.0, eyeM, state.clouds->earthRadiusM(), all, MetaballDetail::kAsBalls);
  EXPECT_EQ(seen.balls, again.balls);
  EXPECT_LT(2 * seen.balls.size(), all.balls.size());
  ASSERT_EQ(seen.clouds.size(), all.clouds.size());
  std::size_t fading = 0;
  for (std::size_t i = 0; i < seen.clouds.size(); ++i) {
    const CloudBalls::Far& far = seen.clouds[i].far;
    EXPECT_EQ(far.share, again.clouds[i].far.share);
    EXPECT_EQ(all.clouds[i].far.share, 0.0f);
    if (far.share >= 1.0f)
      EXPECT_TRUE(seen.ballsOf(i).empty());
    else
      EXPECT_TRUE(std::ranges::equal(seen.ballsOf(i), all.ballsOf(i)));
    fading += far.share > 0.0f && far.share < 1.0f ? 1 : 0;
    const double widths = glm::length(far.placed.baseM - eyeM) / far.placed.widthM;
    // The earth's curve changes little here.
    EXPECT_TRUE(far.share == 0.0f || widths > 3.49);
    EXPECT_TRUE(far.share == 0.0f || far.share == 1.0f || widths < 5.09);
  }
  EXPECT_GT(fading, 2u);
}

// In the thick of a cloud and at its edges the picture comes to hide the balls behind it without a jump.
TEST(MetaballLayer, PicturesFadeInEvenly) {
  for (const double depth : {0.0, 0.1, 5.0, 60.0})
    for (const double part : {1.0, 0.1, 0.02}) {
      EXPECT_EQ(pictureShare(3.4, depth), 0.0f);
      EXPECT_EQ(pictureShare(5.2, depth), 1.0f);
      double before = 0.0;
      for (double widths = 3.4; widths < 5.2; widths += 0.01) {
        const double all = std::max(part * depth, 1e-3),
                     share = static_cast<double>(pictureShare(widths, depth));
        const double hidden = (1.0 - std::exp(-share * all)) / (1.0 - std::exp(-all));
        EXPECT_GE(hidden, before - 1e-4);
        EXPECT_LT(hidden - before, 0.04) << widths << " " << depth << " " << part;
        before = hidden;
      }
    }
}

// The one ball that shades from far away holds what the coarsest level holds.
TEST(CumulusLibrary, TheWholeHoldsAllOfACloud) {
  for (const auto* family : {&cumulusTowers(), &flatCumulus()})
    for (const LibraryCloud& cloud : *family) {
      ASSERT_EQ(cloud.whole.size(), 1u);
      EXPECT_NEAR(field::integralOf(cloud.whole) / field::integralOf(cloud.levels[0]), 1.0, 1e-9);
      EXPECT_GT(cloud.whole[0].radiusM, cloud.radii[0]);
      EXPECT_LT(cloud.whole[0].radiusM, 1.0);
      EXPECT_LT(std::hypot(cloud.whole[0].centreM.x, cloud.whole[0].centreM.y), 0.2);
    }
}

TEST(MetaballLayer, OnlyHeapsAreMadeOfBalls) {
  Scene s = testing::cloudyScene(50.0, {weather::Genus::kCumulus, weather::Genus::kCirrus}, 2.0);
  s.technique = Technique::kMetaballs;
  const weather::Weather weather = buildSky(s, 0.0).weather;
  EXPECT_TRUE(isMetaballs(s, weather.layers[0]));
  EXPECT_FALSE(isMetaballs(s, weather.layers[1]));
  EXPECT_FALSE(isSheet(s, weather.layers[1]));
}

}  // namespace
}  // namespace welkin::scene
