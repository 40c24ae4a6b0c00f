// SPDX-License-Identifier: Apache-2.0
// Stars and planets in pictures: their light whatever the projection and the pixels, and what hides them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/core/colour.h"
#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/projector.h"
#include "welkin/sky/milky_way.h"
#include "welkin/sky/stars.h"

namespace welkin::render {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/milky_way.glsl"
}  // namespace shared

using namespace welkin::testing;
using scene::Projection;

Image<float> drawn(const scene::SkyState& state) {
  static SkyRenderer renderer;
  return renderer.draw(state).luminance;
}

// Of a pixel at its middle; 0 outside the picture's circle. Directions are smooth, so differences serve.
double solidAngle(const scene::Projector& p, int x, int y) {
  const auto at = [&](float dx, float dy) {
    glm::vec3 dir(0.0f);
    float pixelRad = 0.0f;
    const glm::vec2 px(static_cast<float>(x) + 0.5f + dx, static_cast<float>(y) + 0.5f + dy);
    const bool inside = scene::directionAt(p, px, dir, pixelRad);
    return std::pair{glm::dvec3(dir), inside};
  };
  if (!at(0, 0).second) return 0.0;
  return glm::length(
      glm::cross(at(0.5f, 0).first - at(-0.5f, 0).first, at(0, 0.5f).first - at(0, -0.5f).first));
}

template <class Luminance>
double lightIn(const scene::SkyState& state, const Luminance& luminance) {
  const scene::Projector p = scene::projectorOf(state);
  double sum = 0.0;
  for (int y = 0; y < static_cast<int>(p.sizePx.y); ++y)
    for (int x = 0; x < static_cast<int>(p.sizePx.x); ++x) sum += luminance(x, y) * solidAngle(p, x, y);
  return sum;
}
double lightIn(const scene::SkyState& state) {
  const Image<float> picture = drawn(state);
  return lightIn(state, [&](int x, int y) { return luminanceOf(&picture.data[picture.index(x, y)]); });
}

// Illuminance of the Milky Way from directions that pass: the sum over its map's texels.
template <class Passes>
double galaxyLight(const scene::SkyState& state, const Passes& passes) {
  const Image<float>& map = sky::milkyWay();
  const glm::dmat3 enuFromGalactic =
      state.ephemeris.enuFromCelestial *
      glm::dmat3(shared::kGalaxyCentre, shared::kGalaxyAhead, shared::kGalaxyPole);
  double sum = 0.0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double l = 2.0 * kPi * (x + 0.5) / map.width, b = radians(96.0 * ((y + 0.5) / map.height - 0.5));
      const glm::dvec3 enu =
          enuFromGalactic * glm::dvec3(std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b));
      if (enu.z > 0.0 && passes(enu))
        sum += luminanceOf(&map.data[map.index(x, y)]) * std::cos(b) * 2.0 * kPi / map.width * radians(96.0) /
               map.height;
    }
  return sum;
}

// Illuminance of the stars, planets and the Milky Way whose directions pass.
template <class Passes>
double starlight(const scene::SkyState& state, const Passes& passes) {
  double sum = 0.0;
  for (const sky::StarLight& star : sky::starLights(state.scene.time)) {
    const glm::dvec3 enu = state.ephemeris.enuFromCelestial * star.direction;
    if (enu.z > 0.0 && passes(enu)) sum += luminanceOf(&star.illuminance.x);
  }
  for (const sky::Planet& planet : state.ephemeris.planets)
    if (const glm::dvec3& enu = planet.body.direction; enu.z > 0.0 && passes(enu))
      sum += sky::starIlluminanceLux(planet.magnitude);
  return sum + galaxyLight(state, passes);
}

// Nothing but stars, planets and the Milky Way.
scene::SkyState starsAlone(const scene::Scene& s) {
  return airlessSky(s, 0.0);
}

TEST(StarPictures, OfTheWholeSkyHoldAllLight) {
  for (const int height : {512, 128, 32}) {
    const scene::SkyState state =
        starsAlone(projected(moonlessScene(), Projection::kEquirect, 2 * height, height));
    const double expected = starlight(state, [](const glm::dvec3&) { return true; });
    EXPECT_NEAR(lightIn(state) / expected, 1.0, 0.04) << height;
  }
  for (const int size : {512, 96}) {
    const scene::SkyState state = starsAlone(projected(moonlessScene(), Projection::kFisheye, size, size));
    const double expected = starlight(state, [](const glm::dvec3&) { return true; });
    EXPECT_NEAR(lightIn(state) / expected, 1.0, 0.04) << size;
  }
}

TEST(StarPictures, InPerspectiveHoldTheLightInTheirFrame) {
  for (const int width : {960, 160, 48}) {
    const scene::SkyState state =
        starsAlone(looking(sized(moonlessScene(), width, width / 2), 180.0, 50.0, 80.0));
    const scene::Projector p = scene::projectorOf(state);
    const double tangent = p.halfWidthTan;
    const double expected = starlight(state, [&](const glm::dvec3& enu) {
      const glm::dvec3 c = glm::transpose(glm::dmat3(p.enuFromCamera)) * enu;
      return c.y > 0.0 && std::abs(c.x / c.y) < tangent && std::abs(c.z / c.y) < 0.5 * tangent;
    });
    EXPECT_NEAR(lightIn(state) / expected, 1.0, 0.04) << width;
  }
}

TEST(StarPictures, OfTheReferenceRendererHoldTheSameLight) {
  const scene::SkyState state = starsAlone(projected(moonlessScene(), Projection::kFisheye, 96, 96));
  const reference::SkyTracer tracer(state, {});
  const double traced = lightIn(state, [&](int x, int y) {
    double sum = 0.0;
    for (const reference::SkySample& sample : testing::traced(tracer, x, y, 8)) {
      const glm::vec3 l(sample.luminance);
      sum += luminanceOf(&l.x) / 8.0;
    }
    return sum;
  });
  EXPECT_NEAR(traced / lightIn(state), 1.0, 0.04);
}

// Of small pixels: where a faint star is a few hundredths of the airglow, the still takes it for grain, and
// 12 % of the light is lost at 0.36 degrees. At dusk too nothing is made in a frame that was not there
// before: the first frame is by day.
TEST(StarPictures, LiveFramesShowTheSameStars) {
  scene::Scene s = looking(sized(clearScene(20.0), 480, 270), 180.0, 50.0, 50.0);
  constexpr double kNight = 6.0 * 3600.0;
  Image<float> live, without;
  {
    const gpu::Context context;
    const gpu::Texture2D texture(480, 270, {.format = gpu::Format::kRgba32F});
    const gpu::Framebuffer target(texture);
    const auto frame = [&](const scene::Scene& scene) {
      LiveSky sky;
      sky.update(scene, 0.0);
      sky.draw(shading::viewOf(sky.state()), target);
      sky.update(scene, kNight);
      sky.draw(shading::viewOf(sky.state()), target);
      return target.readPicture(0, 3);
    };
    live = frame(s);
    s.output.stars = false;
    without = frame(s);
  }
  scene::SkyState state = scene::buildSky(s, kNight);
  const Image<float> stillWithout = drawn(state);
  state.scene.output.stars = true;
  const Image<float> still = drawn(state);
  double inLive = 0.0, inStill = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < live.data.size(); ++i) {
    const double a = live.data[i] - without.data[i], b = still.data[i] - stillWithout.data[i];
    inLive += a;
    inStill += b;
    apart += std::abs(a - b);
  }
  EXPECT_NEAR(inLive / inStill, 1.0, 0.04);
  // The still is the mean of places within each pixel.
  EXPECT_LT(apart, 0.5 * inStill);
}

TEST(StarPictures, TheMoonHidesStars) {
  scene::SkyState state = starsAlone(looking(sized(moonlessScene(), 96, 96), 180.0, 50.0, 16.0));
  const double open = lightIn(state);
  ASSERT_GT(open, 1e-8);
  state.scene.output.sunDisc = true;
  state.ephemeris.moonIlluminanceLux = 0.0;  // a dark and large one
  state.ephemeris.moon.direction = glm::dvec3(0.0, -std::cos(radians(50.0)), std::sin(radians(50.0)));
  state.ephemeris.moon.angularRadiusRad = radians(15.0);
  EXPECT_LT(lightIn(state), 1e-6 * open);
}

TEST(StarPictures, CloudsHideStarsAndTheSwitchTakesThemAway) {
  const auto added = [](scene::Scene s) {
    s = looking(sized(s, 96, 54), 180.0, 50.0, 70.0);
    const scene::SkyState with = scene::buildSky(s, 0.0);
    scene::SkyState without = with;
    without.scene.output.stars = false;
    return lightIn(with) - lightIn(without);
  };
  const double clear = added(clearScene(-30.0));
  EXPECT_GT(clear, 1e-7);
  EXPECT_LT(std::abs(added(cloudyScene(-30.0, {weather::Genus::kNimbostratus}, 8.0))), 0.01 * clear);
}

TEST(StarPictures, HaveNoneByDay) {
  scene::SkyState state = scene::buildSky(sized(clearScene(20.0), 64, 36), 0.0);
  const Image<float> with = drawn(state);
  state.scene.output.stars = false;
  EXPECT_EQ(with.data, drawn(state).data);
}

// Where the stars begin to be drawn, none is seen.
TEST(StarPictures, DoNotShowAtSunset) {
  scene::SkyState state = scene::buildSky(looking(sized(clearScene(0.0), 320, 180), 90.0, 40.0), 0.0);
  const Image<float> with = drawn(state);
  state.scene.output.stars = false;
  const Image<float> without = drawn(state);
  for (std::size_t i = 0; i < with.data.size(); ++i)
    ASSERT_NEAR(with.data[i] / without.data[i], 1.0f, 0.003f) << i;
}

// Half an hour before sunset: its light is that which the air lets through, and in small pixels it shows.
TEST(StarPictures, ShowVenusBeforeSunset) {
  const scene::Scene s = clearScene(3.5);
  const sky::Planet venus = scene::lightsAt(s, 0.0).ephemeris.planets[1];
  ASSERT_GT(venus.body.elevationDeg, 10.0);
  const auto seen = [&](double fovDeg) {
    return scene::buildSky(looking(sized(s, 64, 64), venus.body.azimuthDeg, venus.body.elevationDeg, fovDeg),
                           0.0);
  };
  const auto without = [](scene::SkyState state) {
    state.scene.output.stars = false;
    return state;
  };
  const scene::SkyState wide = seen(1.5), near = seen(0.5);
  const glm::vec3 arriving =
      wide.atmosphere->transmittanceToSpace(wide.scene.camera.eyeM, venus.body.direction.z) *
      static_cast<float>(sky::starIlluminanceLux(venus.magnitude)) *
      sky::blackBodyColour(sky::starTemperatureK(venus.colour));
  const double expected = luminanceOf(&arriving.x);
  // Of the tenth that is in its halo the still takes a part for grain.
  EXPECT_NEAR((lightIn(wide) - lightIn(without(wide))) / expected, 1.0, 0.1);
  // The same paths with and without it.
  const auto traced = [&](const scene::SkyState& state) {
    const reference::SkyTracer tracer(state, {});
    const scene::Projector p = scene::projectorOf(state);
    double sum = 0.0;
    for (int y = 24; y < 40; ++y)
      for (int x = 24; x < 40; ++x)
        for (const reference::SkySample& sample : testing::traced(tracer, x, y, 16)) {
          const glm::vec3 l(sample.luminance);
          sum += luminanceOf(&l.x) / 16.0 * solidAngle(p, x, y);
        }
    return sum;
  };
  EXPECT_NEAR((traced(wide) - traced(without(wide))) / expected, 1.0, 0.1);
  const Image<float> with = drawn(near), plain = drawn(without(near));
  float most = 0.0f;
  for (std::size_t i = 1; i < with.data.size(); i += 3) most = std::max(most, with.data[i] / plain.data[i]);
  EXPECT_GT(most, 1.05f);
}

// Away from the Milky Way, which is an area of the picture and counts.
TEST(StarPictures, AreExposedAsWithoutStars) {
  SkyRenderer renderer;
  scene::SkyState state = scene::buildSky(looking(sized(moonlessScene(), 640, 360), 75.0, 40.0), 0.0);
  const double with = renderer.draw(state).autoExposureEv;
  state.scene.output.stars = false;
  EXPECT_NEAR(with, renderer.draw(state).autoExposureEv, 0.1);
}

}  // namespace
}  // namespace welkin::render
