// SPDX-License-Identifier: Apache-2.0
// An equirectangular picture as a light source: what it sends onto a horizontal plane is what sun and sky
// send.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/core/utc_time.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"
#include "welkin/sky/ephemeris.h"

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

  // Luminance of a small perspective picture times its solid angle.
  static double lightOf(scene::SkyState state, bool discs) {
    static SkyRenderer renderer;
    state.scene.output.sunDisc = discs;
    const Image<float> picture = renderer.draw(state).luminance;
    const double width = 2.0 * std::tan(0.5 * radians(state.scene.camera.fovDeg));
    const double pixels = static_cast<double>(picture.width) * picture.height;
    return luminanceOf(meanOf(picture)) * pixels * std::pow(width / picture.width, 2);
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

// The full moon, a half moon and two crescents in the dusk, the last one low. Of the largest map here the
// moon is 1.5 pixels wide.
TEST_F(EnvironmentMap, SendsTheLightOfTheMoonAtAnyPhaseAndSize) {
  for (const char* time :
       {"2026-12-24T00:30:00Z", "2026-12-17T20:00:00Z", "2026-12-13T18:00:00Z", "2026-12-13T19:30:00Z"}) {
    scene::Scene scene = moonlitScene();
    scene.time = parseUtcTime(time);
    const scene::SkyState state = scene::buildSky(scene, 0.0);
    const Light expected = expectedOf(state);
    for (const int height : {512, 256, 64})
      EXPECT_NEAR((illuminance(state, height, true) - illuminance(state, height, false)) / expected.direct,
                  1.0, 0.05)
          << time << ", " << height;
  }
}

// Its pixels are 1/2 to 1/40 of the disc's radius.
TEST_F(EnvironmentMap, TelephotoOfTheMoonHasItsLightAtAnyPhase) {
  constexpr int kWidth = 160, kHeight = 90;
  for (const char* time : {"2026-12-24T00:30:00Z", "2026-12-17T20:00:00Z", "2026-12-13T18:00:00Z"})
    for (const double fovDeg : {1.0, 4.0, 20.0}) {
      scene::Scene scene = sized(moonlitScene(), kWidth, kHeight);
      scene.time = parseUtcTime(time);
      const sky::Ephemeris e = sky::ephemeris(scene.time, {kTestLatitudeDeg, 0.0, 0.0});
      scene::SkyState state =
          scene::buildSky(looking(scene, e.moon.azimuthDeg, e.moon.elevationDeg, fovDeg), 0.0);
      const double altitude = state.scene.place.altitudeM + kEyeM;
      const double expected =
          luminanceOf(sky::moonLight(e).illuminance * state.atmosphere->transmittanceToSpace(
                                                          altitude, static_cast<float>(e.moon.direction.z)));
      const double with = lightOf(state, true), without = lightOf(state, false);
      EXPECT_NEAR((with - without) / expected, 1.0, 0.05) << time << ", " << fovDeg;
    }
}

}  // namespace
}  // namespace welkin::render
