// SPDX-License-Identifier: Apache-2.0
// An equirectangular picture as a light source: what it sends onto a horizontal plane is what sun and sky
// send.
#include <gtest/gtest.h>

#include <string>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

constexpr double kEyeM = 2.0;

struct Light {
  double sky = 0.0, direct = 0.0;  // lux on a horizontal plane at the eye
};
Light expectedOf(const scene::SkyState& s) {
  const double altitude = s.scene.place.altitudeM + kEyeM;
  Light light;
  light.sky = luminanceOf(s.atmosphere->skyIlluminance(altitude, s.lights));
  for (const sky::Light& l : s.lights)
    if (l.direction.z > 0.0f)
      light.direct += luminanceOf(
          l.illuminance * s.atmosphere->transmittanceToSpace(altitude, l.direction.z) * l.direction.z);
  return light;
}

class EnvironmentMap : public ::testing::Test {
 protected:
  static double illuminance(scene::SkyState state, int height, bool discs) {
    static SkyRenderer renderer;
    state.scene = projected(state.scene, scene::Projection::kEquirect, 2 * height, height);
    state.scene.output.sunDisc = discs;
    return luminanceOf(horizontalIlluminance(renderer.draw(state).luminance));
  }
};

// The sun is 0.53 degrees wide: 1.5 pixels of the largest map here and a twentieth of one of the smallest.
TEST_F(EnvironmentMap, SendsTheLightOfSunAndSkyAtAnySize) {
  for (const double sun : {60.0, 25.0, 8.0}) {
    const scene::SkyState state = scene::buildSky(clearScene(sun), 0.0);
    const Light expected = expectedOf(state);
    for (const int height : {512, 128, 64}) {
      if (height == 512 && sun != 25.0) continue;  // one large one will do
      EXPECT_NEAR(illuminance(state, height, true) / (expected.sky + expected.direct), 1.0, 0.03)
          << sun << ", " << height;
    }
  }
}

TEST_F(EnvironmentMap, LeavesTheSunOutOnRequest) {
  for (const double sun : {60.0, 8.0}) {
    const scene::SkyState state = scene::buildSky(clearScene(sun), 0.0);
    EXPECT_NEAR(illuminance(state, 128, false) / expectedOf(state).sky, 1.0, 0.03) << sun;
  }
}

TEST_F(EnvironmentMap, SendsTheLightOfTheMoon) {
  const scene::SkyState state = scene::buildSky(moonlitScene(), 0.0);
  const Light expected = expectedOf(state);
  for (const int height : {256, 64})
    EXPECT_NEAR((illuminance(state, height, true) - illuminance(state, height, false)) / expected.direct, 1.0,
                0.05)
        << height;
}

}  // namespace
}  // namespace welkin::render
