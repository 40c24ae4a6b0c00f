// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "test_layers.h"
#include "welkin/core/parallel.h"
#include "welkin/core/units.h"

namespace welkin::field {
namespace {

TEST(Cover, IsNoneOfAnEmptySkyAndAllOfASheet) {
  EXPECT_EQ(measureCover(CloudField(testNoise(), {}, 0.0), {}), 0.0);
  EXPECT_EQ(measureCover(CloudField(testNoise(), {sheetLike()}, 0.0), {}), 1.0);
  CloudLayer thin = sheetLike();
  thin.extinction = 1e-5f;  // optical depth 0.004 straight up, 0.3 only beyond the horizon's slant
  EXPECT_LT(measureCover(CloudField(testNoise(), {thin}, 0.0), {}), 0.02);
}

TEST(Cover, FallsWithTheThreshold) {
  double last = 1.01;
  for (float threshold : {-2.0f, -0.5f, 0.5f, 1.2f, 2.0f, 3.0f}) {
    const double c = measureCover(CloudField(testNoise(), {cumulusLike(threshold)}, 0.0), {});
    EXPECT_LE(c, last + 0.005) << threshold;
    last = c;
  }
}

// What is asked for is delivered, as measured with other and more directions than the calibration's.
TEST(Cover, CalibrationDelivers) {
  for (double asked : {0.05, 0.19, 0.44, 0.75, 1.0}) {
    const CloudField field(testNoise(), {cumulusLike(0.0f)}, 0.0);
    const CloudLayer layer = calibrated(field, 0, asked, {});
    const double delivered = measureCover(CloudField(testNoise(), {layer}, 0.0), {.directions = 7001});
    EXPECT_NEAR(delivered, asked, 0.03) << asked;
  }
}

// The steps of opticalDepth() lose no cloud that makes cover, near or far: fine even steps that trust no hint
// find the same.
TEST(Cover, IsThatOfFineSteps) {
  const CloudField field(testNoise(), {cumulusLike(1.0f)}, 0.0);
  const CoverView view{.directions = 400};
  const std::vector<float> quick = layerOpticalDepths(field, view, 0);
  int hidden = 0, agreeing = 0;
  for (int i = 0; i < view.directions; ++i) {
    // The directions' definition, again: evenly spaced in z, golden angles in azimuth.
    const double z = (i + 0.5) / view.directions, azimuth = i * kPi * (3.0 - std::sqrt(5.0)),
                 r = std::sqrt(1.0 - z * z);
    const glm::vec3 d(static_cast<float>(r * std::cos(azimuth)), static_cast<float>(r * std::sin(azimuth)),
                      static_cast<float>(z));
    double tau = 0.0;
    for (double t = 990.0; t < 2100.0 / z && t < 150e3 && tau < kCoverOpticalDepth; t += 8.0)
      tau += 8.0 * field.extinction(glm::vec3(0, 0, 2) + d * static_cast<float>(t));
    hidden += tau >= kCoverOpticalDepth;
    agreeing += (tau >= kCoverOpticalDepth) == (quick[i] >= kCoverOpticalDepth);
  }
  EXPECT_GT(hidden, 60);
  EXPECT_LT(hidden, 300);
  EXPECT_NEAR(coverOf(quick), static_cast<double>(hidden) / view.directions, 0.0125);  // 0.1 okta
  EXPECT_GE(agreeing, 392);
}

TEST(Cover, OfLayersOneByOneTellsWhatTheyHideTogether) {
  CloudLayer above = cumulusLike(1.0f);
  above.baseM = 3000, above.topM = 3600, above.driftM = {7000.0f, 3000.0f};
  const CloudField field(testNoise(), {cumulusLike(1.2f), above}, 0.0);
  const CoverView view{};
  std::vector<float> sum = layerOpticalDepths(field, view, 0);
  const std::vector<float> second = layerOpticalDepths(field, view, 1);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += second[i];
  EXPECT_NEAR(coverOf(sum), measureCover(field, view), 1e-3);
  EXPECT_GT(coverOf(sum), measureCover(field, view, 0) + 0.02);
}

TEST(Cover, ThinLayersAreThickenedUntilTheyHide) {
  CloudLayer thin = sheetLike();
  thin.extinction = 4e-4f;  // optical depth 0.16 straight up
  const CloudField field(testNoise(), {thin}, 0.0);
  const CloudLayer layer = calibrated(field, 0, 1.0, {});
  EXPECT_GT(layer.extinction, thin.extinction);
  EXPECT_GT(measureCover(CloudField(testNoise(), {layer}, 0.0), {}), 0.99);
}

TEST(Cover, NothingOfALayerBeneathTheEyeIsAllOfIt) {
  CloudLayer shallow = sheetLike();
  shallow.baseM = 0.0f;
  shallow.topM = 1.0f;
  const CloudLayer all = calibrated(CloudField(testNoise(), {shallow}, 0.0), 0, 0.0, {});
  EXPECT_EQ(all.threshold, kLeastThreshold);
  EXPECT_EQ(all.extinction, shallow.extinction);
  const CloudLayer none = calibrated(CloudField(testNoise(), {sheetLike()}, 0.0), 0, 0.0, {});
  EXPECT_EQ(measureCover(CloudField(testNoise(), {none}, 0.0), {}), 0.0);
}

TEST(Cover, IsSearchedInABoundedNumberOfSteps) {
  CloudLayer thin = sheetLike();
  thin.extinction = 1e-6f;  // too little, however often it is thickened
  CoverSearch search;
  for (const CloudLayer& layer : {cumulusLike(0.0f), thin, cumulusLike(0.0f)}) {
    search.start(testNoise(), 0.0, layer, 0.4, {});
    int steps = 0;
    for (; !search.done() && steps < 100; ++steps) search.step();
    EXPECT_LE(steps, CoverSearch::kMostSteps);
    EXPECT_GE(steps, CoverSearch::kMostSteps - 6);
    const CloudLayer found = search.layer(),
                     whole = calibrated(CloudField(testNoise(), {layer}, 0.0), 0, 0.4, {});
    EXPECT_EQ(found.threshold, whole.threshold);
    EXPECT_EQ(found.extinction, whole.extinction);
    search.step();
    EXPECT_EQ(search.layer().threshold, found.threshold);
  }
  std::vector<float> depths(CoverView{}.directions, 0.0f);
  search.addOpticalDepths(depths);
  EXPECT_NEAR(coverOf(depths), 0.4, 0.005);
}

TEST(Cover, IsTheSameForAnyThreadCount) {
  const CloudField field(testNoise(), {cumulusLike(1.0f)}, 0.0);
  const int before = threadCount();
  setThreadCount(1);
  const double one = measureCover(field, {});
  setThreadCount(3);
  EXPECT_EQ(measureCover(field, {}), one);
  setThreadCount(before);
}

}  // namespace
}  // namespace welkin::field
