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
#include "welkin/sky/light.h"

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

// What a picture of a disc has more than one without, in what arrives of the light.
scene::SkyState telephoto(const char* time, const scene::Place& place, bool ofSun, double fovDeg) {
  scene::Scene scene = sized(clearScene(20.0), 160, 90);
  scene.time = parseUtcTime(time);
  scene.place = place;
  scene.output.stars = false;
  const sky::Ephemeris e =
      sky::ephemeris(scene.time, {place.latitudeDeg, place.longitudeDeg, place.altitudeM});
  const sky::Body& body = ofSun ? e.sun : e.moon;
  return scene::buildSky(looking(scene, body.azimuthDeg, body.elevationDeg, fovDeg), 0.0);
}

glm::vec3 arrivingAt(const scene::SkyState& s, const sky::Light& light) {
  return light.illuminance *
         s.atmosphere->transmittanceToSpace(s.scene.place.altitudeM + s.scene.camera.eyeM, light.direction.z);
}

// Crescents of 61, 20 and 2 % of the disc. The last is in the limb's outermost hundredths, whose darkening
// ends a little early.
TEST_F(EnvironmentMap, TelephotoOfTheEclipsedSunHasTheLightThatIsLeft) {
  for (const char* time : {"2026-08-12T18:00:00Z", "2026-08-12T18:19:00Z", "2026-08-12T18:27:00Z"})
    for (const double fovDeg : {1.0, 3.0, 40.0}) {
      const scene::SkyState state = telephoto(time, {42.5987, -5.5671, 840.0}, true, fovDeg);
      const double expected = luminanceOf(arrivingAt(state, sky::sunLight(state.ephemeris)));
      const double with = lightOf(state, true), without = lightOf(state, false);
      const double allowed = state.ephemeris.solarEclipse.obscuration > 0.95 ? 0.14 : 0.06;
      EXPECT_NEAR((with - without) / expected, 1.0, allowed) << time << ", " << fovDeg;
    }
}

// Nothing of the sun is left in totality but its corona.
TEST_F(EnvironmentMap, TheMoonHidesTheSunWholly) {
  for (const double fovDeg : {1.0, 3.0, 20.0, 80.0}) {
    const scene::SkyState state = telephoto("2026-08-12T18:29:04Z", {42.5987, -5.5671, 840.0}, true, fovDeg);
    const double corona = luminanceOf(arrivingAt(state, sky::sunLight(state.ephemeris)));
    const double disc = lightOf(state, true) - lightOf(state, false);
    EXPECT_GT(disc, 0.3 * corona) << fovDeg;
    EXPECT_LT(disc, 1.5 * corona) << fovDeg;
  }
}

TEST_F(EnvironmentMap, TelephotoOfTheEclipsedMoonHasTheLightThatIsLeft) {
  for (const char* time : {"2025-03-14T04:40:00Z", "2025-03-14T05:50:00Z", "2025-03-14T06:59:00Z"})
    for (const double fovDeg : {1.0, 20.0}) {
      const scene::SkyState state = telephoto(time, {40.0, -100.0, 0.0}, false, fovDeg);
      const double expected = luminanceOf(arrivingAt(state, sky::moonLight(state.ephemeris)));
      const double with = lightOf(state, true), without = lightOf(state, false);
      EXPECT_NEAR((with - without) / expected, 1.0, 0.08) << time << ", " << fovDeg;
    }
}

}  // namespace
}  // namespace welkin::render
