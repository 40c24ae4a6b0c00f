// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cover.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test_layers.h"
#include "welkin/core/parallel.h"

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

TEST(Cover, ThinLayersAreThickenedUntilTheyHide) {
  CloudLayer thin = sheetLike();
  thin.extinction = 4e-4f;  // optical depth 0.16 straight up
  const CloudField field(testNoise(), {thin}, 0.0);
  const CloudLayer layer = calibrated(field, 0, 1.0, {});
  EXPECT_GT(layer.extinction, thin.extinction);
  EXPECT_GT(measureCover(CloudField(testNoise(), {layer}, 0.0), {}), 0.99);
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
