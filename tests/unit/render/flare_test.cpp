// SPDX-License-Identifier: Apache-2.0
// The lens flare as it is drawn: what it adds to a picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/testing/engine_depth.h"
#include "tests/testing/foreign_engine.h"
#include "tests/testing/metaball_scene.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"
#include "welkin/shading/lens_flare.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

constexpr int kWidth = 192, kHeight = 108;
constexpr double kSunElevationDeg = 30.0;

class FlareTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  // Turned so far to the right of the sun and up from it.
  static scene::Scene beside(double rightDeg, double upDeg) {
    scene::Scene s = sized(clearScene(kSunElevationDeg), kWidth, kHeight);
    s.technique = scene::Technique::kSkyPlane;
    const sky::Body sun = scene::lightsAt(s, 0.0).ephemeris.sun;
    return looking(s, std::remainder(sun.azimuthDeg + rightDeg, 360.0), sun.elevationDeg + upDeg);
  }

  // What the flare adds, over nothing at all.
  Image<float> added(const scene::Scene& scene, const EngineDepth& depth = {}, float strength = 0.01f) {
    sky.update(scene, 0.0);
    const shading::View view = shading::viewOf(sky.state());
    const auto draw = [&](float flare) {
      target.clear(0, glm::vec4(0.0f));
      sky.draw(view, target, {.backdrop = false, .flare = flare, .depth = depth});
      return target.readPicture(0, 3);
    };
    const Image<float> without = draw(0.0f);
    Image<float> with = draw(strength);
    for (std::size_t i = 0; i < with.data.size(); ++i) with.data[i] -= without.data[i];
    return with;
  }
  double light(const Image<float>& picture) { return luminanceOf(meanOf(picture)); }

  shading::LensFlare flare() {
    const scene::SkyState& state = sky.state();
    return shading::lensFlareOf(shading::partsOf(shading::viewOf(state), kHeight),
                                glm::vec3(state.ephemeris.sun.direction), 0.00465f,
                                shading::sunlightAt(state, state.scene.camera.eyeM));
  }
  // Pixels, from the top left.
  static glm::dvec2 pixelsOf(glm::vec2 clip) {
    return {(0.5 + 0.5 * clip.x) * kWidth, (0.5 - 0.5 * clip.y) * kHeight};
  }

  static scene::Sheet overcast(scene::SheetSurface surface, double bias) {
    scene::Sheet sheet;
    sheet.surface = surface;
    sheet.texels = 64;
    sheet.octaves = 1;
    sheet.cutoff = 0.0;
    sheet.density = 0.01;  // as opaque as bias lets it wherever the pattern is not nought
    sheet.bias = bias;
    return sheet;
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{kWidth, kHeight, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
  LiveSky sky;
};

// The brightest pixel is the sun's; each ghost is brighter in its middle than beyond its rim, where the glow
// alone is.
TEST_F(FlareTest, SpritesAreWhereTheSunSays) {
  const Image<float> got = added(beside(20.0, -8.0));
  EXPECT_EQ(firstBadValue(got), -1);
  glm::ivec2 brightest(0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (luminanceOf(pixel(got, x, y)) > luminanceOf(pixel(got, brightest.x, brightest.y)))
        brightest = {x, y};
  const shading::LensFlare f = flare();
  ASSERT_EQ(f.shown, 1.0f);
  EXPECT_LT(glm::distance(glm::dvec2(brightest) + 0.5, pixelsOf(f.sunAt)), 1.0);
  for (std::size_t i = 1; i < f.sprites.size(); ++i) {
    // Across the line from the sun, on which the others stand.
    const glm::vec2 along = glm::normalize((f.sunAt - f.sprites[i].centre) * glm::vec2(kWidth, kHeight));
    const glm::vec2 across = glm::vec2(-along.y, along.x);
    const auto at = [&](float radii) {
      const glm::dvec2 p = pixelsOf(f.sprites[i].centre + radii * f.sprites[i].halfSize * across);
      return luminanceOf(sample(got, p.x, p.y));
    };
    EXPECT_GT(at(0.6f), at(1.25f)) << i;
    EXPECT_GT(at(-0.6f), at(-1.25f)) << i;
  }
}

// Away from the core of the glow, which is smaller than these pixels, the picture holds the luminance that
// the formula says.
TEST_F(FlareTest, LightIsAbsolute) {
  const Image<float> got = added(beside(0.0, 0.0), {}, 0.02f);
  const shading::LensFlare f = flare();
  // All sprites lie about the sun in the middle of the picture: the sum of light in the picture's plane.
  const glm::vec4 ray = shading::partsOf(shading::viewOf(sky.state()), kHeight).rayScale;
  const double seen = light(got) * 4.0 * ray.x * ray.y;
  const glm::vec3 sun = shading::sunlightAt(sky.state(), 2.0);
  EXPECT_GT(seen, 0.9 * 0.02 * luminanceOf(sun));  // the glow's rim is outside
  EXPECT_LT(seen, 1.02 * 0.02 * luminanceOf(sun));
  EXPECT_GT(f.sprites[0].light.y, 0.0f);
}

TEST_F(FlareTest, IsNotDrawnWithoutTheSun) {
  EXPECT_EQ(light(added(beside(180.0, 0.0))), 0.0);
  EXPECT_EQ(light(added(beside(90.0, 0.0))), 0.0);
  scene::Scene night = beside(0.0, -30.0);
  night.time = addSeconds(night.time, 6.0 * 3600.0);
  EXPECT_EQ(light(added(night)), 0.0);
}

TEST_F(FlareTest, CloudsBeforeTheSunTakeTheirShare) {
  scene::Scene s = beside(15.0, 5.0);
  const double clear = light(added(s));
  ASSERT_GT(clear, 0.0);
  for (const auto surface : {scene::SheetSurface::kPlane, scene::SheetSurface::kSkyPlane,
                             scene::SheetSurface::kDome, scene::SheetSurface::kHemisphere}) {
    s.sheets = {overcast(surface, 1.0)};
    EXPECT_LT(light(added(s)), 1e-3 * clear);
    s.sheets = {overcast(surface, 0.5)};
    EXPECT_NEAR(light(added(s)), 0.5 * clear, 0.01 * clear);
    s.sheets.push_back(overcast(surface, 0.4));
    EXPECT_NEAR(light(added(s)), 0.3 * clear, 0.01 * clear);
    s.camera.eyeM = 3000.0;  // above them
    EXPECT_GT(light(added(s)), clear);
    s.camera.eyeM = 2.0;
  }
}

// A broken sheet dims the flare as much as, in the picture, it hides the sun's disc, whichever part of it is
// there.
TEST_F(FlareTest, FollowsTheTexelsInFrontOfTheSun) {
  scene::Scene s = beside(0.0, 0.0);
  s.camera.fovDeg = 2.0;
  const double clear = light(added(s));
  scene::Sheet sheet;
  sheet.texels = 256;
  sheet.oktas = 4.0;
  sheet.density = 0.97;
  s.sheets = {sheet};
  double least = 1.0, most = 0.0;
  for (s.seed = 1; s.seed <= 12; ++s.seed) {
    const double got = light(added(s)) / clear;
    target.clear(0, glm::vec4(0.0f));
    sky.draw(shading::viewOf(sky.state()), target, {.backdrop = false});
    const Image<float> sheets = target.readPicture(0, 4);
    const shading::LensFlare f = flare();
    const glm::dvec2 centre = pixelsOf(f.sunAt);
    double open = 0.0, count = 0.0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (glm::distance(glm::dvec2(x + 0.5, y + 0.5), centre) > 0.5 * f.sunHalfSize.y * kHeight) continue;
        open += 1.0 - sheets.at(x, y, 3);
        count += 1.0;
      }
    open /= count;
    least = std::min(least, open), most = std::max(most, open);
    EXPECT_NEAR(got, open, 0.05) << s.seed;
  }
  EXPECT_LT(least, 0.3);
  EXPECT_GT(most, 0.7);
}

// The rim of a sheet is drawn thinner and thinner, and so the sun shines through it more and more.
TEST_F(FlareTest, ShinesThroughTheRimsOfSheets) {
  std::vector<double> opens;
  for (const double elevationDeg : {3.0, 4.0, 30.0}) {
    SCOPED_TRACE(elevationDeg);
    scene::Scene s = sized(clearScene(elevationDeg), kWidth, kHeight);
    s.technique = scene::Technique::kSkyPlane;
    const sky::Body sun = scene::lightsAt(s, 0.0).ephemeris.sun;
    s = looking(s, sun.azimuthDeg, sun.elevationDeg, 4.0);
    const double clear = light(added(s));
    s.sheets = {overcast(scene::SheetSurface::kPlane, 1.0)};
    const double got = light(added(s)) / clear;
    target.clear(0, glm::vec4(0.0f));
    sky.draw(shading::viewOf(sky.state()), target, {.backdrop = false});
    const glm::dvec2 centre = pixelsOf(flare().sunAt);
    const double open =
        1.0 - target.readPicture(0, 4).at(static_cast<int>(centre.x), static_cast<int>(centre.y), 3);
    EXPECT_NEAR(got, open, 0.03);
    opens.push_back(open);
  }
  EXPECT_GT(opens[0], opens[1] + 0.1);
  EXPECT_GT(opens[1], opens[2] + 0.1);
  EXPECT_LT(opens[2], 0.01);
}

// Marched clouds and metaballs before the sun.
TEST_F(FlareTest, DoesNotShineThroughVolumes) {
  scene::Scene s = beside(8.0, 5.0);
  const double clear = light(added(s));
  scene::Scene marched = s;
  marched.technique = scene::Technique::kVolume;
  marched.layers = cloudyScene(kSunElevationDeg, {weather::Genus::kStratus}, 8.0).layers;
  EXPECT_LT(light(added(marched)), 0.01 * clear);
  marched.layers = cloudyScene(kSunElevationDeg, {weather::Genus::kCirrostratus}, 8.0).layers;
  const double thin = light(added(marched));
  EXPECT_GT(thin, 0.05 * clear);
  EXPECT_LT(thin, 0.95 * clear);

  const MetaballFolder folder;
  const glm::dvec3 toSun(scene::lightsAt(s, 0.0).lights[0].direction);
  s.metaballs = {folder.ball(500.0, 0.05, 4000.0 * toSun)};
  EXPECT_LT(light(added(s)), 0.01 * clear);
  s.metaballs = {folder.ball(500.0, 0.05, 4000.0 * glm::dvec3(-toSun.x, -toSun.y, toSun.z))};
  EXPECT_NEAR(light(added(s)), clear, 0.01 * clear);
}

TEST_F(FlareTest, AnEnginesThingsHideTheSun) {
  const scene::Scene s = beside(15.0, 5.0);
  const double clear = light(added(s));
  const glm::vec2 sun = flare().sunAt;
  // Something stands to the left of the sun's middle.
  const int edge = static_cast<int>((0.5 + 0.5 * sun.x) * 4096);
  for (const bool reversed : {false, true}) {
    const float far = reversed ? 0.0f : 1.0f;
    Image<float> depth(4096, 8, 1);
    const auto drawn = [&](int from) {
      for (int y = 0; y < depth.height; ++y)
        for (int x = 0; x < depth.width; ++x) depth.at(x, y) = x < from ? 0.5f : far;
      const EngineDepthTexture engine(depth);
      return light(added(s, {engine.id(), reversed}));
    };
    EXPECT_NEAR(drawn(0), clear, 1e-4 * clear);
    EXPECT_NEAR(drawn(edge), 0.5 * clear, 0.13 * clear);
    EXPECT_EQ(drawn(depth.width), 0.0);
  }
}

TEST_F(FlareTest, WritesEightBitsByTheirScale) {
  sky.update(beside(0.0, 0.0), 0.0);
  const gpu::Texture2D bytes(kWidth, kHeight, {.format = gpu::Format::kRgba8});
  const gpu::Framebuffer small(bytes);
  small.clear(0, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  constexpr float kScale = 1e-4f;
  sky.draw(shading::viewOf(sky.state()), small, {.scale = kScale, .backdrop = false, .flare = 0.01f});
  const Image<float> got = small.readPicture(0, 4);
  const Image<float> exact = added(beside(0.0, 0.0));
  for (int x = 0; x < kWidth; ++x) {
    EXPECT_NEAR(got.at(x, 10, 1), std::min(exact.at(x, 10, 1) * kScale, 1.0f), 0.012f);
    EXPECT_EQ(got.at(x, 10, 3), 1.0f);
  }
}

TEST_F(FlareTest, AnEngineFindsItsStateAgain) {
  const Image<float> nothing(16, 8, 1);
  const EngineDepthTexture depth(nothing);
  const ForeignEngine engine;
  sky.update(beside(10.0, 0.0), 0.0);
  const auto before = engine.state();
  sky.draw(shading::viewOf(sky.state()), gpu::Target(engine.framebuffer(), {0, 0, 16, 8}),
           {.scale = 1e-4f, .flare = 0.01f, .depth = {depth.id(), true}});
  EXPECT_EQ(engine.state(), before);
}

}  // namespace
}  // namespace welkin::render
