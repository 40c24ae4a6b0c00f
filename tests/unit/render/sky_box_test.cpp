// SPDX-License-Identifier: Apache-2.0
// A sky box behind thin sheets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>

#include "tests/testing/foreign_engine.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/gpu/context.h"
#include "welkin/io/texel_file.h"
#include "welkin/render/live_sky.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
namespace projection {
using namespace welkin::glsl;
#include "shaders/lib/projection.glsl"
}  // namespace projection

constexpr int kSide = 64;

// A smooth box that looks different everywhere.
glm::vec3 luminanceTowards(glm::vec3 d) {
  d = glm::normalize(d);
  return 1000.0f * (glm::vec3(1.5f) + d + 0.3f * glm::vec3(d.y * d.z, d.z * d.x, d.x * d.y));
}

class SkyBoxTest : public ::testing::Test {
 protected:
  SkyBoxTest() {
    Image<float> strip(6 * kSide, kSide, 3);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < 6 * kSide; ++x) {
        const auto at = [](int i) { return 2.0f * (static_cast<float>(i) + 0.5f) / kSide - 1.0f; };
        const glm::vec3 l = luminanceTowards(projection::cubeDirection(x / kSide, at(x % kSide), at(y)));
        for (int c = 0; c < 3; ++c) strip.at(x, y, c) = l[c];
      }
    io::writeTexels(file_, io::toTexels(strip, {io::Channels::kRgb, io::ValueType::kFloat}));
  }
  ~SkyBoxTest() override { std::filesystem::remove(file_); }
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  scene::Scene boxed(double headingDeg, double pitchDeg) const {
    scene::Scene s = looking(sized(clearScene(40.0), 48, 32), headingDeg, pitchDeg, 90.0);
    s.technique = scene::Technique::kSkyPlane;
    s.skyBox.strip = file_;
    return s;
  }
  Image<float> drawn(const scene::Scene& s) {
    sky.update(s, 0.0);
    sky.draw(shading::viewOf(sky.state()), target);
    return target.readPicture(0, 3);
  }
  // The direction of a pixel's centre, by the same camera.
  glm::vec3 directionAt(int x, int y) const {
    const shading::ViewParts v = shading::partsOf(shading::viewOf(sky.state()), 32);
    const glm::vec2 clip(2.0f * (static_cast<float>(x) + 0.5f) / 48.0f - 1.0f,
                         1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / 32.0f);
    return glm::normalize(v.enuFromCamera * glm::vec3(v.rayScale.x * clip.x + v.rayScale.z,
                                                      v.rayScale.y * clip.y + v.rayScale.w, -1.0f));
  }

  const std::string file_ = ::testing::TempDir() + "welkin_sky_box_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".exr";
  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{48, 32, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
  LiveSky sky;
};

TEST_F(SkyBoxTest, EachDirectionShowsItsOwn) {
  for (const double heading : {0.0, 130.0, 250.0})
    for (const double pitch : {-80.0, 0.0, 35.0, 80.0}) {
      const Image<float> got = drawn(boxed(heading, pitch));
      for (int y = 0; y < 32; y += 5)
        for (int x = 0; x < 48; x += 5) {
          const glm::vec3 expected = luminanceTowards(directionAt(x, y)), found = pixel(got, x, y);
          for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c] / expected[c], 1.0f, 0.02f) << heading << pitch;
        }
    }
}

// Turned clockwise by 90 degrees, what lay in the north is seen in the east.
TEST_F(SkyBoxTest, TurnsAndStandsOnOtherAxes) {
  scene::Scene s = boxed(90.0, 20.0);
  s.skyBox.turnDeg = 90.0;
  Image<float> got = drawn(s);
  const glm::vec3 d = directionAt(30, 9);
  glm::vec3 expected = luminanceTowards({-d.y, d.x, d.z});
  EXPECT_NEAR(glm::distance(pixel(got, 30, 9), expected) / glm::length(expected), 0.0f, 0.02f);

  s.skyBox.turnDeg = 0.0;
  s.skyBox.axes = scene::BoxAxes::kYUp;
  got = drawn(s);
  expected = luminanceTowards({d.x, d.z, -d.y});
  EXPECT_NEAR(glm::distance(pixel(got, 30, 9), expected) / glm::length(expected), 0.0f, 0.02f);
}

TEST_F(SkyBoxTest, SheetsHideItAndTheGroundMayStay) {
  scene::Scene s = boxed(20.0, 30.0);
  const Image<float> box = drawn(s);
  s.sheets.resize(1);
  s.sheets[0].texels = 64;
  s.sheets[0].cutoff = 0.0;
  s.sheets[0].density = 0.5;
  EXPECT_NE(drawn(s).data, box.data);
  s.sheets.clear();
  EXPECT_EQ(drawn(s).data, box.data);

  s.camera.pitchDeg = -40.0;
  const Image<float> below = drawn(s);
  s.skyBox.ground = true;
  const Image<float> ground = drawn(s);
  EXPECT_GT(std::abs(pixel(below, 20, 30).x / pixel(ground, 20, 30).x - 1.0f), 0.1f);
  scene::Scene without = s;
  without.skyBox = {};
  EXPECT_EQ(pixel(drawn(without), 20, 30), pixel(ground, 20, 30));
}

TEST_F(SkyBoxTest, WhatIsTooBrightForHalvesKeepsItsScale) {
  Image<float> strip(24, 4, 3);
  std::fill(strip.data.begin(), strip.data.end(), 5e5f);
  io::writeTexels(file_, io::toTexels(strip, {io::Channels::kRgb, io::ValueType::kFloat}));
  EXPECT_NEAR(pixel(drawn(boxed(0.0, 20.0)), 9, 9).y / 5e5f, 1.0f, 2e-3f);
}

TEST_F(SkyBoxTest, AMissingOneIsAnErrorEachTime) {
  scene::Scene s = boxed(0.0, 20.0);
  s.skyBox.strip = "none.exr";
  EXPECT_THROW(sky.update(s, 0.0), IoError);
  EXPECT_THROW(sky.update(s, 0.0), IoError);
  EXPECT_NO_THROW(drawn(boxed(0.0, 20.0)));
}

TEST_F(SkyBoxTest, WhereOneIsMissingTheSkyStaysAsItWas) {
  const scene::Scene there = boxed(0.0, 20.0);
  const Image<float> before = drawn(there);
  scene::Scene s = there;
  s.skyBox.strip = "none.exr";
  EXPECT_THROW(sky.update(s, 0.0), IoError);
  sky.draw(shading::viewOf(sky.state()), target);
  EXPECT_EQ(target.readPicture(0, 3).data, before.data);
  EXPECT_EQ(drawn(there).data, before.data);
}

TEST_F(SkyBoxTest, AnEngineFindsItsStateAgain) {
  const ForeignEngine engine;
  const auto before = engine.state();
  sky.update(boxed(0.0, 20.0), 0.0);
  EXPECT_EQ(engine.state(), before);
  sky.draw(shading::viewOf(sky.state()), gpu::Target(engine.framebuffer(), {0, 0, 16, 8}), {.scale = 1e-4f});
  EXPECT_EQ(engine.state(), before);
}

}  // namespace
}  // namespace welkin::render
