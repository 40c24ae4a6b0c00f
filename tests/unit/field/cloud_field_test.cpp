// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cloud_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "test_layers.h"
#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"

namespace welkin::field {
namespace {

namespace shared {
using namespace welkin::glsl;
using field::CloudLayer;
#include "shaders/lib/clouds.glsl"
}  // namespace shared

TEST(CloudField, IsEmptyOutsideItsLayers) {
  const CloudField field(testNoise(), {cumulusLike(-4.0f)}, 0.0);
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const float x = 2e4f * random.uniform(), y = 2e4f * random.uniform();
    EXPECT_EQ(field.extinction({x, y, 500.0f}), 0.0f);
    EXPECT_EQ(field.extinction({x, y, 2600.0f}), 0.0f);
  }
}

TEST(CloudField, NeverExceedsWhatTheBodyMayHave) {
  const CloudLayer layer = cumulusLike(-4.0f);
  const CloudField field(testNoise(), {layer}, 0.0);
  Random random(2);
  float greatest = 0.0f;
  for (int i = 0; i < 20000; ++i) {
    const float e = field.extinction(
        {1e4f * random.uniform(), 1e4f * random.uniform(), 1000.0f + 1000.0f * random.uniform()});
    EXPECT_GE(e, 0.0f);
    greatest = std::max(greatest, e);
  }
  EXPECT_GT(greatest, 0.9f * layer.extinction);
  EXPECT_LE(greatest, 1.31f * layer.extinction);
}

// Seen from afar, without the small noise, clouds cover as much of the sky as they do with it.
TEST(CloudField, HidesAsMuchFromAfar) {
  CloudLayer layer = cumulusLike(0.6f);
  const std::shared_ptr<const CloudNoise> noise = testNoise();
  const shared::sampler2D placement{&noise->placement, shared::Wrap::kRepeat, shared::Wrap::kRepeat};
  const shared::sampler3D shape{&noise->shape, shared::Wrap::kRepeat},
      detailNoise{&noise->detail, shared::Wrap::kRepeat};
  for (const float edge : {0.06f, 0.12f, 0.4f}) {
    layer.edge = edge;
    double hidden[2] = {0.0, 0.0};
    Random random(5);
    constexpr int kRays = 1500;
    for (int ray = 0; ray < kRays; ++ray) {
      const glm::vec3 from(9e4f * random.uniform(), 9e4f * random.uniform(), layer.baseM);
      const glm::vec3 way = glm::normalize(glm::vec3(1.0f, 0.3f, 0.6f));
      for (const int with : {0, 1}) {
        double depth = 0.0;
        constexpr float kStep = 15.0f;
        for (float t = 0.5f * kStep; from.z + way.z * t < layer.topM; t += kStep) {
          const glm::vec3 q = from + way * t;
          float clear = 0.0f;
          depth += static_cast<double>(kStep *
                                       shared::cloudExtinctionFrom(layer, shape, detailNoise, q,
                                                                   shared::cloudSurface(layer, placement, q),
                                                                   static_cast<float>(with), clear));
        }
        hidden[with] += (1.0 - std::exp(-depth)) / kRays;
      }
    }
    EXPECT_GT(hidden[1], 0.1);
    EXPECT_NEAR(hidden[0] / hidden[1], 1.0, 0.03) << "edge " << edge;
  }
}

// Moving the pattern with the wind is moving the eye against it.
TEST(CloudField, DriftsWithTheWind) {
  CloudLayer still = cumulusLike(0.5f);
  CloudLayer moved = still;
  moved.driftM += glm::vec2(300.0f, -120.0f);
  const CloudField a(testNoise(), {still}, 0.0), b(testNoise(), {moved}, 0.0);
  Random random(3);
  int cloudy = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::vec3 p(3000 * random.uniform(), 3000 * random.uniform(), 1000 + 900 * random.uniform());
    const float e = a.extinction(p);
    cloudy += e > 0.0f;
    EXPECT_NEAR(e, b.extinction(p + glm::vec3(300.0f, -120.0f, 0.0f)), 0.05f * still.extinction);
  }
  EXPECT_GT(cloudy, 100);
}

// Streaked cloud in a slanting frame, whose periods all differ.
CloudLayer slanting() {
  CloudLayer l = cumulusLike(0.2f);
  l.along = glm::normalize(glm::vec2(0.4f, -0.9f));
  l.stretch = 1.7f, l.cellM = 17321.3f, l.patchM = 41000.7f, l.warpM = 500.0f;
  l.shapeM = 2345.6f, l.shapeStretch = 1.3f, l.detailM = 456.7f;
  return l;
}

// The largest difference of the extinctions of a at q and of b at q + byM, of that in the body; and how many
// places have cloud.
std::pair<double, int> differenceOf(const CloudLayer& a, const CloudLayer& b, glm::vec2 byM) {
  const std::shared_ptr<const CloudNoise> noise = testNoise();
  const shared::sampler2D placement{&noise->placement, shared::Wrap::kRepeat, shared::Wrap::kRepeat};
  const shared::sampler3D shape{&noise->shape, shared::Wrap::kRepeat},
      detail{&noise->detail, shared::Wrap::kRepeat};
  Random random(3);
  double most = 0.0;
  int cloudy = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::vec3 q(3e4f * random.uniform(), 3e4f * random.uniform(), 1000.0f + 900.0f * random.uniform());
    float clear = 0.0f;
    const float here = shared::cloudExtinction(a, placement, shape, detail, q, clear),
                there = shared::cloudExtinction(b, placement, shape, detail, q + glm::vec3(byM, 0.0f), clear);
    cloudy += here > 0.0f;
    most = std::max(most, static_cast<double>(std::abs(here - there) / a.extinction));
  }
  return {most, cloudy};
}

// By ways that a float can say, both ways of moving are one: over no, one and several periods.
TEST(CloudField, MovesByWholePeriodsAsByTheWholeWay) {
  for (const glm::dvec2 byM : {glm::dvec2(900.0, -300.0), {21000.0, 9000.0}, {-60000.0, 90000.0}}) {
    CloudLayer moved = slanting(), plain = slanting();
    moveLayer(moved, byM);
    plain.driftM += glm::vec2(byM);
    const auto [most, cloudy] = differenceOf(plain, moved, glm::vec2(0.0f));
    EXPECT_LT(most, 0.02) << byM.x;
    EXPECT_GT(cloudy, 400);
    EXPECT_EQ(moved.driftM == plain.driftM, std::abs(byM.x) < 1000.0);
  }
}

// After a year in a gale a quarter of a second is as smooth as at first.
TEST(CloudField, MovesOnSmoothlyHoweverFarItIs) {
  const glm::dvec2 windMps(130.0, -75.0);
  for (const double fromS : {0.0, 31.6e6, -31.6e6}) {
    CloudLayer before = slanting(), after = slanting();
    moveLayer(before, windMps * fromS);
    moveLayer(after, windMps * (fromS + 0.25));
    const glm::vec2 wayM(0.25 * windMps);
    const auto [most, cloudy] = differenceOf(before, after, wayM);
    EXPECT_LT(most, 0.02) << fromS;
    EXPECT_GT(cloudy, 400);
    EXPECT_GT(differenceOf(before, after, -wayM).first, 0.2) << fromS;
    EXPECT_LT(glm::length(before.driftM), 2.0f * before.cellM);
  }
}

// And back again.
TEST(CloudField, MovesBackToWhereItWas) {
  CloudLayer moved = slanting();
  moveLayer(moved, {3.1e9, -2.2e9});
  moveLayer(moved, {-3.1e9, 2.2e9});
  EXPECT_LT(differenceOf(slanting(), moved, glm::vec2(0.0f)).first, 0.02);
}

// Layers follow the curve of the earth: 100 km away a level line of sight is 785 m higher above the ground.
TEST(CloudField, FollowsTheCurveOfTheEarth) {
  CloudLayer sheet = sheetLike();
  sheet.baseM = 600.0f;
  sheet.topM = 1000.0f;
  const CloudField field(testNoise(), {sheet}, 0.0);
  EXPECT_EQ(field.extinction({100e3f, 0.0f, 0.0f - 300.0f}), 0.0f);
  EXPECT_GT(field.extinction({100e3f, 0.0f, 0.0f}), 0.0f);
  EXPECT_EQ(field.extinction({0.0f, 0.0f, 0.0f}), 0.0f);
}

// A homogeneous shell has a known optical depth straight up and, on a sphere, along a slant.
TEST(CloudField, OpticalDepthOfAShellIsExact) {
  const CloudLayer sheet = sheetLike();
  const CloudField field(testNoise(), {sheet}, 0.0);
  const float vertical = sheet.extinction * (sheet.topM - sheet.baseM);
  const float softened =
      0.5f * (sheet.bottomSoft + sheet.topSoft);  // smoothstep fades integrate to half their width
  EXPECT_NEAR(field.opticalDepth({0, 0, 2}, {0, 0, 1}, 1e9f), vertical * (1 - softened), 0.01f * vertical);
  const double elevation = radians(10.0);
  const glm::vec3 d(static_cast<float>(std::cos(elevation)), 0.0f, static_cast<float>(std::sin(elevation)));
  auto crossing = [&](double h) {  // distance to the sphere at height h
    const double r = kEarthRadiusM + 2, s = std::sin(elevation) * r;
    return -s + std::sqrt(s * s + (h - 2) * (2 * kEarthRadiusM + h + 2));
  };
  const double slant = (crossing(sheet.topM) - crossing(sheet.baseM)) * sheet.extinction;
  EXPECT_NEAR(field.opticalDepth({0, 0, 2}, d, 1e9f), slant * (1 - softened), 0.02 * slant);
}

TEST(CloudField, SeesLayersFromAboveAndFromWithin) {
  const CloudLayer sheet = sheetLike();
  const CloudField field(testNoise(), {sheet}, 0.0);
  const float through = field.opticalDepth({0, 0, 2}, {0, 0, 1}, 1e9f);
  // Steps grow with distance: from far above, the thin fades at base and top are only just resolved.
  EXPECT_NEAR(field.opticalDepth({0, 0, 9000}, {0, 0, -1}, 1e9f), through, 0.02f * through);
  const float middle = 0.5f * (sheet.baseM + sheet.topM);
  EXPECT_NEAR(field.opticalDepth({0, 0, middle}, {0, 0, 1}, 1e9f) +
                  field.opticalDepth({0, 0, middle}, {0, 0, -1}, 1e9f),
              through, 0.02f * through);
}

// Empty-space steps must not jump over cloud: fine steps that trust no hint find the same optical depth.
TEST(CloudField, EmptySpaceStepsMissNothing) {
  const CloudField field(testNoise(), {cumulusLike(1.0f)}, 0.0);
  double quick = 0, slow = 0;
  for (int i = 0; i < 300; ++i) {
    const double azimuth = i * 2.4, elevation = radians(15.0 + 70.0 * i / 300.0);
    const glm::vec3 d(static_cast<float>(std::cos(elevation) * std::sin(azimuth)),
                      static_cast<float>(std::cos(elevation) * std::cos(azimuth)),
                      static_cast<float>(std::sin(elevation)));
    quick += std::min(field.opticalDepth({0, 0, 2}, d, 50.0f), 50.0f);
    double tau = 0;
    const double from = 990.0 / std::sin(elevation), to = 2010.0 / std::sin(elevation);
    for (double t = from; t < to && tau < 50; t += 6.0)
      tau += 6.0 * field.extinction(glm::vec3(0, 0, 2) + d * static_cast<float>(t));
    slow += std::min(tau, 50.0);
  }
  EXPECT_NEAR(quick, slow, 0.04 * slow);
}

TEST(CloudField, RefusesTooManyLayers) {
  EXPECT_THROW(CloudField(testNoise(), std::vector<CloudLayer>(kMaxLayers + 1, sheetLike()), 0.0),
               ParameterError);
}

}  // namespace
}  // namespace welkin::field
