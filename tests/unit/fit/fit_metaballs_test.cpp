// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/fit_metaballs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/field/cloud_map.h"

namespace welkin::fit {
namespace {

using field::Metaball;
using field::VoxelFrame;

struct Map {
  Volume<float> density;
  VoxelFrame frame;
};

// P. Man's kind of cloud, smaller.
Map smallCloud() {
  field::CloudMapParams p{.nx = 24, .ny = 18, .nz = 12, .voxelM = 40};
  p.noise.cellVoxels = 6;
  const field::Ellipsoid e = field::centredEllipsoid(p);
  return {field::cloudMap(p, {&e, 1}), {24, 18, 12, glm::dvec3(40), field::firstVoxelM(p)}};
}

Map mansCloud() {
  const field::CloudMapParams p;
  const field::Ellipsoid e = field::centredEllipsoid(p);
  return {field::cloudMap(p, {&e, 1}), {48, 36, 24, glm::dvec3(20), field::firstVoxelM(p)}};
}

FitLevel fitOne(const Map& map, std::size_t count, const FitParams& params = {}) {
  std::vector<FitLevel> levels(1);
  levels[0].count = count;
  fitMetaballs(map.density, map.frame, params, levels);
  EXPECT_EQ(levels[0].balls.size(), count);
  EXPECT_TRUE(levels[0].complete);
  return levels[0];
}

// The error as anybody would measure it, from the balls alone.
double relativeL2(const Map& map, const std::vector<Metaball>& balls) {
  const field::MetaballField f(balls);
  double difference = 0.0, norm = 0.0;
  for (int z = 0; z < map.frame.nz; ++z)
    for (int y = 0; y < map.frame.ny; ++y)
      for (int x = 0; x < map.frame.nx; ++x) {
        const auto d = static_cast<double>(map.density.at(x, y, z));
        const double e = f(map.frame.firstVoxelM + map.frame.voxelSizeM * glm::dvec3(x, y, z)) - d;
        difference += e * e;
        norm += d * d;
      }
  return std::sqrt(difference / norm);
}

// Among them those that end in a minimum beside the truth, at 0.003 to 0.17, where balls are only moved.
TEST(FitMetaballs, RecoversCloudsOfTwentyKnownBalls) {
  struct Cloud {
    std::uint64_t seed;
    double leastRadiusM, leastDensity;
  };
  const glm::dvec3 spanM(480, 320, 240);
  for (const auto& [seed, leastRadiusM, leastDensity] : {Cloud{5, 60, 0.3},
                                                         {7, 60, 0.3},
                                                         {14, 60, 0.3},
                                                         {25, 60, 0.3},
                                                         {27, 40, 0.3},
                                                         {61, 40, 0.3},
                                                         {59, 80, 0.5}}) {
    Random random(seed);
    std::vector<Metaball> truth(20);
    for (Metaball& b : truth) {
      for (int a = 0; a < 3; ++a) b.centreM[a] = 80.0 + spanM[a] * random.uniform();
      b.radiusM = leastRadiusM * (1.0 + random.uniform());
      b.density = leastDensity + random.uniform();
    }
    const VoxelFrame frame{32, 24, 20, glm::dvec3(20), glm::dvec3(10)};
    const Map map{field::rasterise(truth, frame), frame};
    const FitLevel level = fitOne(map, 20);
    EXPECT_LT(level.relativeL2, 1e-3) << "seed " << seed << ", radii from " << leastRadiusM;
    EXPECT_NEAR(field::integralOf(level.balls) / field::integralOf(truth), 1.0, 1e-3) << seed;
  }
}

TEST(FitMetaballs, ErrorFallsWithTheNumberOfBallsAndIsWhatItSays) {
  const Map map = smallCloud();
  double before = 1.0;
  for (const std::size_t count : {1U, 8U, 40U, 150U}) {
    const FitLevel level = fitOne(map, count, {.effort = 0.3});
    EXPECT_LT(level.relativeL2, 0.9 * before) << count;
    EXPECT_NEAR(level.relativeL2, relativeL2(map, level.balls), 1e-5);
    double squares = 0.0;
    for (const float v : map.density.data) squares += static_cast<double>(v) * static_cast<double>(v);
    EXPECT_NEAR(level.rmse, level.relativeL2 * std::sqrt(squares / (24 * 18 * 12)), 1e-6);
    for (const Metaball& b : level.balls) EXPECT_GE(b.density, 0.0);
    before = level.relativeL2;
  }
}

// What P. Man's two phases reach (about 0.5, 0.36, 0.29), what weights add, and what the refinement does.
TEST(FitMetaballs, IsAsNearAsItIsSaidToBe) {
  const Map map = mansCloud();
  EXPECT_NEAR(fitOne(map, 30, {.method = FitMethod::kMan}).relativeL2, 0.48, 0.05);
  EXPECT_NEAR(fitOne(map, 100, {.method = FitMethod::kMan}).relativeL2, 0.38, 0.06);
  EXPECT_LT(fitOne(map, 30, {.method = FitMethod::kWeights}).relativeL2, 0.30);
  EXPECT_LT(fitOne(map, 30).relativeL2, 0.20);
  EXPECT_LT(fitOne(map, 100).relativeL2, 0.145);
  EXPECT_LT(fitOne(map, 1000, {.effort = 0.0}).relativeL2, 0.07);
}

TEST(FitMetaballs, SignedBallsMayCarve) {
  // A ball with a hole: positive balls alone do it less well.
  const std::vector<Metaball> truth = {{{200, 200, 200}, 150, 1.0}, {{200, 200, 200}, 70, -0.8}};
  const VoxelFrame frame{20, 20, 20, glm::dvec3(20), glm::dvec3(10)};
  const Map map{field::rasterise(truth, frame), frame};
  const FitLevel level = fitOne(map, 5, {.isSigned = true});
  EXPECT_LT(level.relativeL2, 0.02);
  double least = 0.0;
  for (const Metaball& b : level.balls) least = std::min(least, b.density);
  EXPECT_LT(least, -0.1);
  EXPECT_GT(fitOne(map, 5).relativeL2, 1.5 * level.relativeL2);
}

TEST(FitMetaballs, IsTheSameInAnyNumberOfThreads) {
  const auto compare = [](std::size_t count, FitMethod method) {
    const FitParams params{.method = method, .effort = 0.15};
    const Map map = count > 100 ? mansCloud() : smallCloud();
    setThreadCount(1);
    const FitLevel one = fitOne(map, count, params);
    setThreadCount(3);
    const FitLevel three = fitOne(map, count, params);
    setThreadCount(0);
    EXPECT_EQ(one.balls, three.balls) << count;
  };
  compare(20, FitMethod::kRefined);  // several moves at once
  compare(400, FitMethod::kRefined);
  compare(400, FitMethod::kWeights);
  compare(100, FitMethod::kMan);
}

// Large maps begin on coarser copies; the error must not suffer.
TEST(FitMetaballs, LargeMapsGoFromCoarseToFine) {
  const std::vector<Metaball> truth = {
      {{300, 320, 300}, 200, 1.0}, {{420, 300, 340}, 150, 0.6}, {{300, 300, 450}, 120, 0.9}};
  const VoxelFrame frame{70, 66, 68, glm::dvec3(10), glm::dvec3(0)};
  EXPECT_LT(fitOne({field::rasterise(truth, frame), frame}, 3).relativeL2, 0.01);
}

TEST(FitMetaballs, GoesOnFromWhatThereIs) {
  const Map map = smallCloud();
  std::vector<FitLevel> levels(1);
  levels[0].count = 30;
  fitMetaballs(map.density, map.frame, {.method = FitMethod::kWeights}, levels);
  const double before = levels[0].relativeL2;
  double first = 0.0;
  // With no time at all the balls stay as they are.
  fitMetaballs(map.density, map.frame, {.timeLimitS = 0.0}, levels);
  EXPECT_NEAR(levels[0].relativeL2, before, 1e-6);
  fitMetaballs(map.density, map.frame, {.effort = 0.2}, levels, [&](const FitProgress& p) {
    if (first == 0.0 && p.relativeL2 < 1.0) first = p.relativeL2;
  });
  EXPECT_LE(first, before + 1e-6);
  EXPECT_LT(levels[0].relativeL2, before);
}

// The methods without refinement find new densities for the balls that there are.
TEST(FitMetaballs, GoesOnWithDensitiesAlone) {
  const Map map = smallCloud();
  std::vector<FitLevel> given(1);
  given[0].count = 30;
  fitMetaballs(map.density, map.frame, {.method = FitMethod::kWeights}, given);
  const double best = given[0].relativeL2;
  for (std::size_t i = 0; i < given[0].balls.size(); ++i) given[0].balls[i].density *= i % 2 == 0 ? 6.0 : 2.0;
  double before = relativeL2(map, given[0].balls);
  for (const FitMethod method : {FitMethod::kMan, FitMethod::kWeights}) {
    std::vector<FitLevel> levels = given;
    fitMetaballs(map.density, map.frame, {.method = method}, levels);
    for (std::size_t i = 0; i < levels[0].balls.size(); ++i) {
      EXPECT_NEAR(levels[0].balls[i].radiusM, given[0].balls[i].radiusM, 1e-9);
      EXPECT_NEAR(levels[0].balls[i].centreM.x, given[0].balls[i].centreM.x, 1e-9);
    }
    EXPECT_LT(levels[0].relativeL2, 0.95 * before);  // by one factor already, by one for each ball still more
    before = levels[0].relativeL2;
  }
  EXPECT_NEAR(before, best, 1e-4);
}

// Without time every method ends after its first round, with balls that are somewhere near.
TEST(FitMetaballs, TimeLimitHoldsForWhatFitsBeginWith) {
  const Map map = mansCloud();
  for (const FitMethod method : {FitMethod::kMan, FitMethod::kWeights, FitMethod::kRefined}) {
    std::vector<FitLevel> levels(1);
    levels[0].count = 100;
    int calls = 0;
    fitMetaballs(map.density, map.frame, {.method = method, .timeLimitS = 0.0}, levels,
                 [&](const FitProgress&) { ++calls; });
    EXPECT_LE(calls, 4);
    EXPECT_EQ(levels[0].balls.size(), 100U);
    EXPECT_TRUE(levels[0].complete);
    EXPECT_LT(levels[0].relativeL2, 0.8);
  }
}

TEST(FitMetaballs, StopsWithTheBestSoFar) {
  const Map map = smallCloud();
  std::vector<FitLevel> levels(2);
  levels[0].count = 20;
  levels[1].count = 60;
  int calls = 0;
  const auto stop = [&](const FitProgress& p) {
    if (p.level == 1 && ++calls == 60) throw Interrupted();
  };
  EXPECT_THROW(fitMetaballs(map.density, map.frame, {}, levels, stop), Interrupted);
  EXPECT_TRUE(levels[0].complete);
  EXPECT_FALSE(levels[1].complete);
  ASSERT_EQ(levels[1].balls.size(), 60U);
  EXPECT_NEAR(levels[1].relativeL2, relativeL2(map, levels[1].balls), 1e-5);
  EXPECT_LT(levels[1].relativeL2, 0.5);
}

// Their squares are beyond what floats hold; the errors are those of the same map of middling densities.
TEST(FitMetaballs, DensitiesMayHaveAnyUnit) {
  const Map map = smallCloud();
  const FitLevel middling = fitOne(map, 10, {.effort = 0.0});
  for (const float unit : {0x1p-80f, 0x1p80f}) {
    Map other = map;
    for (float& v : other.density.data) v *= unit;
    const FitLevel level = fitOne(other, 10, {.effort = 0.0});
    EXPECT_DOUBLE_EQ(level.relativeL2, middling.relativeL2);
    EXPECT_DOUBLE_EQ(level.rmse, middling.rmse * static_cast<double>(unit));
    for (std::size_t i = 0; i < level.balls.size(); ++i) {
      EXPECT_EQ(level.balls[i].centreM, middling.balls[i].centreM);
      EXPECT_DOUBLE_EQ(level.balls[i].density, middling.balls[i].density * static_cast<double>(unit));
    }
  }
}

TEST(FitMetaballs, TinyMaps) {
  Volume<float> one(1, 1, 1, 1);
  one.data[0] = 0.7F;
  EXPECT_LT(fitOne({one, {1, 1, 1}}, 1).relativeL2, 1e-4);
  Volume<float> flat(6, 6, 1, 1);
  std::fill(flat.data.begin(), flat.data.end(), 0.5F);
  EXPECT_LT(fitOne({flat, {6, 6, 1}}, 36).relativeL2, 0.1);
  for (const FitMethod method : {FitMethod::kRefined, FitMethod::kWeights, FitMethod::kMan})
    EXPECT_LT(fitOne({flat, {6, 6, 1}}, 1, {.method = method}).relativeL2, 0.95);
}

TEST(FitMetaballs, WhatCannotBeFittedIsRefused) {
  std::vector<FitLevel> levels(1);
  levels[0].count = 2;
  Volume<float> map(3, 3, 3, 1);
  const VoxelFrame frame{3, 3, 3};
  EXPECT_THROW(fitMetaballs(Volume<float>(), {}, {}, levels), ParameterError);
  EXPECT_THROW(fitMetaballs(map, frame, {}, levels), ParameterError);  // 0 everywhere
  map.data[5] = 1.0F;
  EXPECT_THROW(fitMetaballs(map, frame, {}, levels), ParameterError);  // 2 balls, 1 voxel
  EXPECT_THROW(fitMetaballs(map, {3, 3, 3, glm::dvec3(1e300)}, {}, levels), ParameterError);
  map.data[6] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(fitMetaballs(map, frame, {}, levels), ParameterError);
  map.data[6] = 1.0F;
  EXPECT_THROW(fitMetaballs(map, frame, {.method = FitMethod::kMan, .isSigned = true}, levels),
               ParameterError);
  levels[0].balls = {{{0, 0, 0}, 1, 1}};
  EXPECT_THROW(fitMetaballs(map, frame, {}, levels), ParameterError);  // goes on from one ball with two
  levels[0].balls = {{{0, 0, 0}, 1, 1}, {{0, 0, 0}, 1, -1}};
  EXPECT_THROW(fitMetaballs(map, frame, {}, levels), ParameterError);
  levels[0].balls = {{{900, 0, 0}, 1, 1}, {{0, 900, 0}, 1, 1}};  // of another map
  EXPECT_THROW(fitMetaballs(map, frame, {}, levels), ParameterError);
  levels[0].count = 0;
  levels[0].balls.clear();
  EXPECT_THROW(fitMetaballs(map, frame, {}, levels), ParameterError);
}

}  // namespace
}  // namespace welkin::fit
