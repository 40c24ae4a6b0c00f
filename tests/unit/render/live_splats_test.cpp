// SPDX-License-Identifier: Apache-2.0
// Metaballs in somebody's frame loop, seen through a camera of the engine's own.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "tests/testing/metaball_scene.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

constexpr int kWidth = 64, kHeight = 36;

class LiveSplatsTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  // From an eye towards a direction, with the planes of somebody's depth buffer.
  static shading::View viewFrom(const glm::dvec3& eyeM, const glm::dvec3& towards, double nearM = 1.0,
                                double farM = 1e6) {
    shading::View view;
    view.view = glm::lookAt(eyeM, eyeM + towards, glm::dvec3(0.0, 0.0, 1.0));
    view.projection =
        glm::perspective(glm::radians(30.0), static_cast<double>(kWidth) / kHeight, nearM, farM);
    return view;
  }

  Image<float> drawn(const scene::Scene& scene, const shading::View& view, const LiveOptions& options = {}) {
    sky.update(scene, 0.0);
    sky.draw(view, target, options);
    return target.readPicture(0, 3);
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{kWidth, kHeight, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
  MetaballFolder folder;
  LiveSky sky;
};

TEST_F(LiveSplatsTest, NoPlaneOfTheEngineCutsThem) {
  scene::Scene s = clearScene(40.0);
  const glm::dvec3 eyeM(0.0, 0.0, 2.0), north(0.0, 1.0, 0.3);
  const Image<float> clear = drawn(s, viewFrom(eyeM, north));
  s.metaballs.push_back(folder.ball(400.0, 0.02, {0.0, 3000.0, 900.0}));
  const Image<float> there = drawn(s, viewFrom(eyeM, north));
  EXPECT_GT(relativeDifference(there, clear), 0.01);
  EXPECT_LT(relativeDifference(drawn(s, viewFrom(eyeM, north, 0.1, 1000.0)), there), 1e-3);
  EXPECT_LT(relativeDifference(drawn(s, viewFrom(eyeM, north, 5000.0, 1e6)), there), 1e-3);
}

// The ball that hides the sun from one place does not hide it from another.
TEST_F(LiveSplatsTest, TheFlareIsHiddenFromWhereTheEyeIs) {
  const scene::Scene clear = clearScene(40.0);
  const glm::dvec3 toSun = scene::lightsAt(clear, 0.0).ephemeris.sun.direction;
  const glm::dvec3 here(0.0, 0.0, 2.0), away(4000.0, 0.0, 2.0);
  const auto flare = [&](const scene::Scene& scene, const glm::dvec3& eyeM) {
    const shading::View view = viewFrom(eyeM, toSun);
    const double without = luminanceOf(meanOf(drawn(scene, view)));
    return luminanceOf(meanOf(drawn(scene, view, {.flare = 0.05f}))) - without;
  };
  const double open = flare(clear, here);
  ASSERT_GT(open, 0.0);
  for (const glm::dvec3& behind : {here, away}) {
    scene::Scene s = clear;
    s.metaballs.push_back(folder.ball(300.0, 0.05, behind + 2000.0 * toSun));
    const glm::dvec3& beside = behind == here ? away : here;
    EXPECT_LT(flare(s, behind), 0.01 * open);
    EXPECT_NEAR(flare(s, beside), open, 0.02 * open);
  }
}

}  // namespace
}  // namespace welkin::render
