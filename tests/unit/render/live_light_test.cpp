// SPDX-License-Identifier: Apache-2.0
// The light of a sky for an engine's own things, against the sky that is known and against sums over whole
// pictures of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "tests/testing/foreign_engine.h"
#include "tests/testing/metaball_scene.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/error.h"
#include "welkin/core/units.h"
#include "welkin/field/metaballs.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/sky_renderer.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

constexpr glm::dvec3 kEyeM{0.0, 0.0, 2.0};

class LiveLightTest : public ::testing::Test {
 protected:
  void TearDown() override {
    context.makeCurrent();
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }
  // The whole sky and ground from the eye, zenith on top, without discs.
  Image<float> map(scene::Scene s) {
    s = projected(s, scene::Projection::kEquirect, 256, 128);
    s.output.sunDisc = false;
    Image<float> picture = SkyRenderer().draw(scene::buildSky(s, 0.0)).luminance;
    context.makeCurrent();
    return picture;
  }
  gpu::Context context{{.debug = true}};
};

// Direction, solid angle and luminance of each pixel of a map, in the middle of which is a heading.
template <class F>
void eachPixel(const Image<float>& map, double headingDeg, F&& f) {
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double elevation = kPi * (0.5 - (y + 0.5) / map.height),
                   azimuth = radians(headingDeg) + 2.0 * kPi * ((x + 0.5) / map.width - 0.5);
      const glm::dvec3 d(std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                         std::sin(elevation));
      f(d, std::cos(elevation) * kPi / map.height * 2.0 * kPi / map.width, pixel(map, x, y));
    }
}

glm::vec3 illuminanceOf(const Image<float>& map, double headingDeg, const glm::dvec3& normal) {
  glm::dvec3 sum(0.0);
  eachPixel(map, headingDeg, [&](const glm::dvec3& d, double steradians, const glm::vec3& luminance) {
    sum += std::max(glm::dot(d, normal), 0.0) * steradians * glm::dvec3(luminance);
  });
  return glm::vec3(sum);
}

SkyLight harmonicsOf(const Image<float>& map, double headingDeg) {
  SkyLight light;
  eachPixel(map, headingDeg, [&](const glm::dvec3& d, double steradians, const glm::vec3& luminance) {
    const std::array<float, 9> h = skyHarmonics(glm::vec3(d));
    for (std::size_t i = 0; i < 9; ++i)
      light.luminance[i] += static_cast<float>(steradians) * h[i] * luminance;
  });
  return light;
}

const glm::dvec3 kNormals[] = {{0, 0, 1},  {0, 0, -1},    {1, 0, 0},      {-1, 0, 0},     {0, 1, 0},
                               {0, -1, 0}, {0.6, 0, 0.8}, {0, -0.6, 0.8}, {-0.6, 0, -0.8}};

TEST(SkyLightTest, AnEvenSkyLightsPlanesByTheirSkyShare) {
  SkyLight light;
  const auto pi = static_cast<float>(kPi);
  light.luminance[0] = glm::vec3(100.0f) * 2.0f * std::sqrt(pi);  // 100 cd/m2 from everywhere
  for (const glm::dvec3& n : kNormals) EXPECT_NEAR(light.illuminance(glm::vec3(n)).y, 100.0f * pi, 0.01f);
}

TEST(SkyLightTest, HarmonicsAreOrthonormal) {
  constexpr int kRows = 60, kColumns = 120;
  double products[9][9] = {};
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const double e = kPi * ((y + 0.5) / kRows - 0.5), a = 2.0 * kPi * (x + 0.5) / kColumns;
      const auto h =
          skyHarmonics(glm::vec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)));
      const double steradians = std::cos(e) * kPi / kRows * 2.0 * kPi / kColumns;
      for (std::size_t i = 0; i < 9; ++i)
        for (std::size_t j = 0; j < 9; ++j) products[i][j] += steradians * static_cast<double>(h[i] * h[j]);
    }
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) EXPECT_NEAR(products[i][j], i == j ? 1.0 : 0.0, 2e-3) << i << ", " << j;
}

// The clear sky as the atmosphere has it, and the sun through its air.
TEST_F(LiveLightTest, IsThatOfTheClearSky) {
  for (const double elevationDeg : {60.0, 25.0, 8.0}) {
    const scene::Scene s = clearScene(elevationDeg);
    LiveSky sky;
    sky.update(s, 0.0);
    const SkyLight light = sky.light(kEyeM);
    const scene::SkyState& state = sky.state();
    const double altitudeM = s.place.altitudeM + kEyeM.z;
    const double expected = luminanceOf(state.atmosphere->skyIlluminance(altitudeM, state.lights));
    // Nine coefficients make it a little more where most of it comes from low down.
    EXPECT_NEAR(luminanceOf(light.illuminance({0, 0, 1})) / expected, 1.0, 0.06) << elevationDeg;
    EXPECT_EQ(light.sun.throughClouds, 1.0f) << elevationDeg;
    EXPECT_NEAR(degrees(std::asin(static_cast<double>(light.sun.direction.z))), elevationDeg, 0.1);
    // Some 128 klx at the top of the air, and on the ground as textbooks have it.
    const double sun = luminanceOf(light.sun.illuminance);
    EXPECT_NEAR(sun,
                luminanceOf(state.lights[0].illuminance *
                            state.atmosphere->transmittanceToSpace(
                                altitudeM, static_cast<double>(state.lights[0].direction.z))),
                1e-3 * sun);
    EXPECT_GT(sun, elevationDeg > 20.0 ? 6e4 : 1e4);
    EXPECT_LT(sun, 1.2e5);
  }
}

// All of it on level ground, discs and sky, is what a map of the whole sky with its sun sends there.
TEST_F(LiveLightTest, SunAndSkyAreThatOfAMapWithItsSun) {
  scene::Scene s = clearScene(40.0);
  LiveSky sky;
  sky.update(s, 0.0);
  const SkyLight light = sky.light(kEyeM);
  s = projected(s, scene::Projection::kEquirect, 256, 128);
  const double expected =
      luminanceOf(horizontalIlluminance(SkyRenderer().draw(scene::buildSky(s, 0.0)).luminance));
  context.makeCurrent();
  EXPECT_NEAR(
      luminanceOf(light.illuminance({0, 0, 1}) + light.sun.illuminance * light.sun.direction.z) / expected,
      1.0, 0.03);
}

// From all sides, under clouds of all kinds too: as exactly as nine coefficients can.
TEST_F(LiveLightTest, PlanesHaveTheLightOfAMapOfTheSky) {
  scene::Scene sheets = cloudyScene(35.0, {Genus::kStratocumulus, Genus::kCirrus}),
               heaps = cloudyScene(35.0, {Genus::kCumulus});
  sheets.technique = scene::Technique::kSkyPlane;
  heaps.layers[0].technique = scene::Technique::kMetaballs;
  heaps.layers[0].oktas = 2.0;
  const std::pair<const char*, scene::Scene> skies[] = {{"clear", clearScene(35.0)},
                                                        {"sheets", sheets},
                                                        {"volumes", cloudyScene(35.0, {Genus::kCumulus})},
                                                        {"metaballs", heaps}};
  for (const auto& [name, s] : skies) {
    const Image<float> picture = map(s);
    LiveSky sky;
    sky.update(s, 0.0);
    const SkyLight light = sky.light(kEyeM);
    double most = 0.0;
    for (const glm::dvec3& n : kNormals)
      most = std::max(most, luminanceOf(illuminanceOf(picture, sky.state().headingDeg, n)));
    const SkyLight harmonic = harmonicsOf(picture, sky.state().headingDeg);
    for (const glm::dvec3& n : kNormals) {
      const double expected = luminanceOf(illuminanceOf(picture, sky.state().headingDeg, n)),
                   found = luminanceOf(light.illuminance(glm::vec3(n)));
      EXPECT_NEAR(found / most, expected / most, 0.035) << name << ": " << n.x << ' ' << n.y << ' ' << n.z;
      EXPECT_NEAR(found / most, luminanceOf(harmonic.illuminance(glm::vec3(n))) / most, 0.03) << name;
    }
  }
}

// In the middle of a ball's shadow, and beside it.
TEST_F(LiveLightTest, SunThroughABallIsByItsDepth) {
  const MetaballFolder folder;
  scene::Scene s = clearScene(50.0);
  const glm::dvec3 toSun(scene::lightsAt(s, 0.0).lights[0].direction);
  const glm::dvec3 centreM = toSun * (1500.0 / toSun.z);
  for (const double extinction : {0.0005, 0.002}) {
    s.metaballs = {folder.ball(400.0, extinction, centreM)};
    LiveSky sky;
    sky.update(s, 0.0);
    const double depth = field::columnAlong({centreM, 400.0, extinction}, {0.0, 0.0, 0.0}, toSun);
    const SkyLight under = sky.light({0.0, 0.0, 0.0});
    EXPECT_NEAR(under.sun.throughClouds, std::exp(-depth), 0.03) << depth;
    EXPECT_NEAR(under.sun.illuminance.y, under.sun.throughClouds * under.sun.overClouds.y, 1.0f);
    EXPECT_GT(under.sun.throughClouds, 0.01f);
    EXPECT_EQ(sky.light({3000.0, 0.0, 0.0}).sun.throughClouds, 1.0f);
  }
}

TEST_F(LiveLightTest, ClosedDecksHideTheSunAndBrokenOnesHereAndThere) {
  LiveSky sky;
  sky.update(cloudyScene(40.0, {Genus::kStratus}, 8.0), 0.0);
  const SkyLight closed = sky.light(kEyeM);
  EXPECT_LT(closed.sun.throughClouds, 0.01f);
  EXPECT_GT(closed.illuminance({0, 0, 1}).y, 1000.0f);
  sky.update(cloudyScene(60.0, {Genus::kCumulus}, 4.0), 0.0);
  int open = 0, shaded = 0;
  float off = 0.0f;
  for (int i = 0; i < 24; ++i) {
    const glm::dvec3 at(1300.0 * (i % 6), 1300.0 * (i / 6), 2.0);
    const SkyLight light = sky.light(at);
    const float through = light.sun.throughClouds;
    const float depth = sky.state().clouds->opticalDepth(glm::vec3(at), light.sun.direction, 1e9f);
    off += std::abs(through - std::exp(-depth)) / 24.0f;
    open += through > 0.9f ? 1 : 0;
    shaded += through < 0.1f ? 1 : 0;
  }
  EXPECT_LT(off, 0.05f);  // from the field, point by point
  EXPECT_GE(open, 4);
  EXPECT_GE(shaded, 4);
  EXPECT_GE(open + shaded, 16);
  // From over them all the sun is free.
  EXPECT_EQ(sky.light({0.0, 0.0, 9000.0}).sun.throughClouds, 1.0f);
}

TEST_F(LiveLightTest, TheMoonIsALightByNight) {
  LiveSky sky;
  sky.update(moonlitScene(), 0.0);
  const SkyLight light = sky.light(kEyeM);
  EXPECT_EQ(light.sun.illuminance, glm::vec3(0.0f));
  EXPECT_GT(luminanceOf(light.moon.illuminance), 0.05);
  EXPECT_LT(luminanceOf(light.moon.illuminance), 0.5);
  EXPECT_LT(luminanceOf(light.illuminance({0, 0, 1})), 0.1);
}

TEST_F(LiveLightTest, LeavesFramesAndTheEngineAsTheyAre) {
  scene::Scene s = sized(cloudyScene(35.0, {Genus::kCumulus, Genus::kCirrus}), 64, 36);
  s.technique = scene::Technique::kSkyPlane;
  const gpu::Texture2D picture(64, 36, {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer to(picture);
  LiveSky plain, sky;
  EXPECT_THROW(sky.light(kEyeM), ParameterError);
  plain.update(s, 0.0);
  sky.update(s, 0.0);
  const shading::View view = shading::viewOf(sky.state());
  plain.draw(view, to);
  const Image<float> expected = to.readPicture(0, 3);
  sky.light({500.0, 0.0, 800.0});
  sky.draw(view, to);
  EXPECT_EQ(to.readPicture(0, 3).data, expected.data);
  const ForeignEngine engine;
  const auto before = engine.state();
  sky.light(kEyeM);
  EXPECT_EQ(engine.state(), before);
}

}  // namespace
}  // namespace welkin::render
