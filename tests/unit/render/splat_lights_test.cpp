// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs, as balls and as pictures, in the light of two lamps and of a sky that is not the same
// all around: without air, each light by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/gpu/context.h"
#include "welkin/render/splat_pass.h"
#include "welkin/scene/cumulus_library.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

constexpr int kSide = 64;
constexpr double kEyeM = 1500.0, kDistanceM = 6000.0, kWidthM = 1200.0;

glm::vec3 towards(double azimuthDeg, double elevationDeg) {
  const double a = radians(azimuthDeg), e = radians(elevationDeg);
  return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

// Of a half of the sphere, of one luminance and so much more to the east, less to the west.
sky::LightMoments hemisphere(float luminance, float side, float eastward) {
  const auto pi = static_cast<float>(kPi);
  return {glm::vec3(2.0f * pi * luminance),
          {glm::vec3(2.0f * pi / 3.0f * eastward), glm::vec3(0.0f), glm::vec3(side * pi * luminance)}};
}

// A thick cloud in the north, level with the eye: of balls, or a picture.
class SplatLightsTest : public ::testing::TestWithParam<bool> {
 protected:
  SplatLightsTest() {
    scene::Scene s = looking(sized(clearScene(40.0), kSide, kSide), 0.0, 0.0, 2.0 * degrees(std::atan(0.15)));
    s.camera.eyeM = kEyeM;
    state = airlessSky(s, 0.0);
    state.ambient = {};
    view = shading::partsOf(shading::viewOf(state), kSide);
    if (GetParam()) {
      far = {&scene::cumulusTowers()[1],
             {{0.0, kDistanceM, kEyeM - 0.35 * kWidthM}, kWidthM, 0.7, 0.04, 0},
             1.0f};
    } else {
      for (const double x : {-250.0, 250.0})
        for (const double z : {-200.0, 200.0}) balls.push_back({{x, kDistanceM, kEyeM + z}, 400.0, 0.05});
    }
  }
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  // In front of others that shade it.
  Image<float> drawn(const std::vector<field::Metaball>& other = {}) {
    SplatTarget to{target};
    tables.update(state);
    pass.setSky(shading::skyUniforms(state), shading::splatLights(state));
    std::vector<SplatCloud> clouds(2);
    clouds[0].balls = balls;
    clouds[0].far = far;
    clouds[1].balls = other;
    target.clear();
    pass.draw(clouds, view, tables, to);
    return target.readPicture();
  }
  Image<float> drawn(float first, float second) {
    state.lights[0].illuminance = glm::vec3(first);
    state.lights[1].illuminance = glm::vec3(second);
    return drawn();
  }
  // Luminance of the left (west) or the right (east) of the cloud for each unit of what it hides.
  static double halfOf(const Image<float>& picture, bool east) {
    double light = 0.0, hidden = 0.0;
    for (int y = 0; y < kSide; ++y)
      for (int x = east ? kSide / 2 : 0; x < (east ? kSide : kSide / 2); ++x) {
        light += static_cast<double>(picture.at(x, y, 1));
        hidden += static_cast<double>(picture.at(x, y, 3));
      }
    EXPECT_GT(hidden, 50.0);
    return light / hidden;
  }
  static double eastToWest(const Image<float>& picture) {
    return halfOf(picture, true) / halfOf(picture, false);
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{kSide, kSide, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
  SkyTextures tables;
  SplatPass pass{SplatDetail::kStill};
  scene::SkyState state;
  shading::ViewParts view;
  std::vector<field::Metaball> balls;
  scene::CloudBalls::Far far;
};

// Light adds up, whichever light comes first.
TEST_P(SplatLightsTest, TwoLightsAreTheSumOfEach) {
  state.lights[0].direction = towards(250.0, 20.0);
  state.lights[1].direction = towards(100.0, 35.0);
  const Image<float> both = drawn(3.0f, 2.0f), first = drawn(3.0f, 0.0f), second = drawn(0.0f, 2.0f);
  std::swap(state.lights[0].direction, state.lights[1].direction);
  const Image<float> turned = drawn(2.0f, 3.0f);
  double brightest = 0.0, own = 0.0;
  for (std::size_t i = 0; i < both.data.size(); ++i) {
    if (i % 4 == 3) continue;
    brightest = std::max(brightest, static_cast<double>(both.data[i]));
    own = std::max(own, static_cast<double>(second.data[i]));
  }
  EXPECT_GT(own, 0.2 * brightest);
  for (std::size_t i = 0; i < both.data.size(); ++i) {
    if (i % 4 == 3) continue;
    ASSERT_NEAR(both.data[i], first.data[i] + second.data[i], 2e-3 * brightest);
    ASSERT_NEAR(both.data[i], turned.data[i], 2e-3 * brightest);
  }
}

TEST_P(SplatLightsTest, TheSecondLightHasASide) {
  state.lights[0].direction = towards(180.0, 60.0);
  for (const double azimuthDeg : {100.0, 260.0}) {
    state.lights[1].direction = towards(azimuthDeg, 10.0);
    const double without = eastToWest(drawn(1.0f, 0.0f)), with = eastToWest(drawn(1.0f, 4.0f));
    if (azimuthDeg < 180.0)
      EXPECT_GT(with, 1.25 * without);
    else
      EXPECT_LT(with, without / 1.25);
  }
}

// And what stands in it shades the cloud; what stands beside it does not.
TEST_P(SplatLightsTest, OthersShadeItFromTheSecondLight) {
  const glm::vec3 side = towards(100.0, 10.0), behind = towards(180.0, 60.0);
  state.lights[0].direction = behind;
  state.lights[1].direction = side;
  const glm::dvec3 middle(0.0, kDistanceM, kEyeM);
  const std::vector<field::Metaball> before{{middle + 3000.0 * glm::dvec3(side), 900.0, 0.05}},
      beside{{middle + 3000.0 * glm::dvec3(towards(10.0, 10.0)), 900.0, 0.05}};
  state.lights[0].illuminance = glm::vec3(0.0f);
  state.lights[1].illuminance = glm::vec3(1.0f);
  const double alone = halfOf(drawn(), true);
  EXPECT_LT(halfOf(drawn(before), true), 0.7 * alone);
  const Image<float> open = drawn(beside);
  EXPECT_NEAR(open.at(kSide / 2, kSide / 2, 1) / drawn().at(kSide / 2, kSide / 2, 1), 1.0, 0.02);
}

// In equal light from everywhere a cloud is as bright as what is behind it: it vanishes.
TEST_P(SplatLightsTest, VanishesInAWhiteFurnace) {
  sky::LightMoments above = hemisphere(5.0f, 1.0f, 0.0f), below = hemisphere(5.0f, -1.0f, 0.0f);
  state.ambient.above = state.ambient.aboveLow = state.ambient.aboveHigh = above;
  state.ambient.below = state.ambient.belowHigh = below;
  state.ambient.ground = glm::vec3(5.0f);
  const Image<float> picture = drawn();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      ASSERT_NEAR(picture.at(x, y, 1), 5.0f * picture.at(x, y, 3), 0.02f) << x << ", " << y;
}

// A sky that is brighter in the east makes the cloud brighter there, and no brighter on the whole: with one
// that is brighter in the west by as much it comes to twice the even one.
TEST_P(SplatLightsTest, TheBrightSideOfTheSkyIsSeenAndAddsNothing) {
  const auto under = [&](float eastward) {
    state.ambient.above = state.ambient.aboveLow = state.ambient.aboveHigh = hemisphere(5.0f, 1.0f, eastward);
    state.ambient.below = state.ambient.belowHigh = hemisphere(5.0f, -1.0f, eastward);
    state.ambient.ground = glm::vec3(5.0f);
    return drawn();
  };
  const Image<float> east = under(3.0f), west = under(-3.0f), even = under(0.0f);
  EXPECT_NEAR(eastToWest(even), 1.0, 0.01);
  EXPECT_GT(eastToWest(east), 1.08);
  EXPECT_LT(eastToWest(west), 1.0 / 1.08);
  for (const bool side : {false, true})
    EXPECT_NEAR(halfOf(east, side) + halfOf(west, side), 2.0 * halfOf(even, side), 0.2);
}

// All that a ball sends out, into all directions, is at most what it takes of the light, and of that not much
// is lost.
TEST(SplatConservation, ABallSendsOutNoMoreThanItTakes) {
  gpu::Context context({.debug = true});
  gpu::Texture2D texture(kSide, kSide, {.format = gpu::Format::kRgba32F});
  gpu::Framebuffer target(texture);
  scene::Scene s = looking(sized(clearScene(40.0), kSide, kSide), 0.0, 0.0, 20.0);
  s.camera.eyeM = kEyeM;
  scene::SkyState state = airlessSky(s, 1.0);
  state.ambient = {};
  state.lights[0].direction = towards(30.0, 50.0);
  SkyTextures tables;
  tables.update(state);
  SplatPass pass{SplatDetail::kStill};
  pass.setSky(shading::skyUniforms(state), shading::splatLights(state));
  // Of a ball in a direction: green summed over the picture, and what it hides.
  const auto seen = [&](const glm::dvec3& dir, double density) {
    state.headingDeg = degrees(std::atan2(dir.x, dir.y));
    state.scene.camera.pitchDeg = degrees(std::asin(dir.z));
    const std::vector<field::Metaball> balls{{glm::dvec3(0.0, 0.0, kEyeM) + 6000.0 * dir, 900.0, density}};
    const SplatCloud cloud{.balls = balls};
    target.clear();
    pass.draw({&cloud, 1}, shading::partsOf(shading::viewOf(state), kSide), tables, {target});
    const Image<float> picture = target.readPicture();
    glm::dvec2 sum(0.0);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) sum += glm::dvec2(picture.at(x, y, 1), picture.at(x, y, 3));
    return sum;
  };
  const glm::dvec3 light(state.lights[0].direction),
      across = glm::normalize(glm::cross(light, {0.0, 0.0, 1.0})), up = glm::cross(across, light);
  for (const double density : {1e-4, 1e-3, 0.01, 0.1}) {
    const double taken = seen(-light, density).y;
    // Finer where the droplets' peak is, on the far side from the light.
    double sent = 0.0;
    constexpr int kAngles = 20, kTurns = 4;
    for (int i = 0; i < kAngles; ++i)
      for (int j = 0; j < kTurns; ++j) {
        const auto edge = [](double x) { return std::cos(kPi * x * x * x); };
        const double middle = kPi * std::pow((i + 0.5) / kAngles, 3.0), turn = 2.0 * kPi * (j + 0.5) / kTurns;
        const double steradians =
            2.0 * kPi / kTurns * (edge(static_cast<double>(i) / kAngles) - edge((i + 1.0) / kAngles));
        const glm::dvec3 dir =
            std::cos(middle) * light + std::sin(middle) * (std::cos(turn) * across + std::sin(turn) * up);
        sent += steradians * seen(dir, density).x;
      }
    EXPECT_LT(sent / taken, 1.02) << density;  // the sum over directions is within a hundredth
    EXPECT_GT(sent / taken, 0.9) << density;
  }
  EXPECT_TRUE(context.takeErrors().empty());
}

INSTANTIATE_TEST_SUITE_P(BallsAndPictures, SplatLightsTest, ::testing::Bool(),
                         [](const auto& is) { return is.param ? "Pictures" : "Balls"; });

}  // namespace
}  // namespace welkin::render
