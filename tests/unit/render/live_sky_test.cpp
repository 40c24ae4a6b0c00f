// SPDX-License-Identifier: Apache-2.0
// A sky in somebody's frame loop.
#include "welkin/render/live_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <glm/ext/matrix_transform.hpp>
#include <iostream>
#include <new>
#include <vector>

#include "tests/testing/foreign_engine.h"
#include "tests/testing/metaball_scene.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_volumes.h"
#include "welkin/render/octaves_pass.h"
#include "welkin/render/sky_renderer.h"

namespace {
std::atomic<long> gAllocations{0};
}

// Counted for the whole program; the tests look at differences.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++gAllocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

class LiveSkyTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  // Two flat layers, one with living octaves, and a dome, small enough to be quick.
  static scene::Scene thinScene(double sunElevationDeg = 35.0) {
    scene::Scene s = cloudyScene(sunElevationDeg, {Genus::kStratocumulus, Genus::kCirrus});
    s.technique = scene::Technique::kSkyPlane;
    scene::Sheet dome = scene::sheetOf(field::ThesisTexture::kDome);
    dome.texels = 32;
    dome.heightM = 3000.0;
    s.sheets.push_back(dome);
    scene::Sheet living;
    living.pattern = scene::SheetPattern::kOctaves;
    living.tier = scene::SheetTier::kEmbossed;
    living.heightM = 5000.0;
    living.texels = 64;
    living.octaves = 4;
    living.oktas = 3.0;
    s.sheets.push_back(living);
    s.output.width = 64;
    s.output.height = 36;
    return s;
  }

  Image<float> drawn(LiveSky& sky) {
    sky.draw(shading::viewOf(sky.state()), target);
    return target.readPicture(0, 3);
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{64, 36, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
};

TEST_F(LiveSkyTest, AFrameIsTheSameFirstOrAfterOthers) {
  const scene::Scene s = thinScene();
  LiveSky first;
  first.update(s, 100.0);
  const Image<float> expected = drawn(first);
  EXPECT_EQ(firstBadValue(expected), -1);

  LiveSky other;
  other.update(thinScene(10.0), 0.0);
  drawn(other);
  for (int i = 0; i < 20; ++i) {
    other.update(s, 7.7 * i);
    drawn(other);
  }
  other.update(s, 100.0);
  EXPECT_EQ(drawn(other).data, expected.data);
}

// From noon to midnight and back.
TEST_F(LiveSkyTest, ACutAndBackGivesTheSameFrame) {
  const scene::Scene s = thinScene(80.0);
  LiveSky sky;
  sky.update(s, 0.0);
  const Image<float> noon = drawn(sky);
  sky.update(s, 43200.0);
  const Image<float> midnight = drawn(sky);
  EXPECT_LT(luminanceOf(meanOf(midnight)), 1e-3 * luminanceOf(meanOf(noon)));
  sky.update(s, 0.0);
  EXPECT_EQ(drawn(sky).data, noon.data);
}

TEST_F(LiveSkyTest, SheetsHideAndShadeAndMove) {
  scene::Scene s = thinScene();
  s.camera.pitchDeg = 40.0;
  LiveSky sky;
  sky.update(s, 0.0);
  const Image<float> start = drawn(sky);
  sky.update(s, 60.0);
  EXPECT_NE(drawn(sky).data, start.data);
  s.layers.clear();
  s.sheets.clear();
  sky.update(s, 0.0);
  const Image<float> clear = drawn(sky);
  EXPECT_NE(clear.data, start.data);
  // Without sheets the backdrop is the sky as it is.
  EXPECT_GT(meanOf(clear, 0, 18).z, meanOf(clear, 0, 18).x);
}

TEST_F(LiveSkyTest, AnEngineFindsItsStateAgain) {
  LiveSky sky;
  const ForeignEngine engine;
  const auto before = engine.state();
  sky.update(thinScene(), 0.0);
  EXPECT_EQ(engine.state(), before);
  sky.draw(shading::viewOf(sky.state()), gpu::Target(engine.framebuffer(), {0, 0, 16, 8}), {.scale = 1e-4f});
  EXPECT_EQ(engine.state(), before);
}

TEST_F(LiveSkyTest, NothingIsDrawnBeforeThereIsASky) {
  LiveSky sky;
  const shading::View view = shading::viewOf(scene::buildSky(thinScene(), 0.0));
  const auto expectNoSky = [&] {
    EXPECT_THROW(sky.draw(view, target), ParameterError);
    EXPECT_THROW(sky.airVolume(view), ParameterError);
    EXPECT_THROW(sky.state(), ParameterError);
  };
  expectNoSky();
  scene::Scene bad = thinScene();
  bad.metar = "EGLL 211200Z FEW0X2";
  EXPECT_THROW(sky.update(bad, 0.0), ParseError);
  expectNoSky();
  bad = thinScene();
  bad.place.latitudeDeg = 123.0;
  EXPECT_THROW(sky.update(bad, 0.0), ParameterError);
  EXPECT_THROW(sky.update(thinScene(), std::nan("")), ParameterError);
  sky.update(thinScene(), 0.0);
  const Image<float> picture = drawn(sky);
  // A mistake leaves the sky that was there.
  EXPECT_THROW(sky.update(bad, 0.0), ParameterError);
  EXPECT_EQ(drawn(sky).data, picture.data);
}

TEST_F(LiveSkyTest, DrawsAllocateNothing) {
  LiveSky sky;
  const sky::Body sun = scene::lightsAt(thinScene(), 0.0).ephemeris.sun;
  sky.update(looking(thinScene(), sun.azimuthDeg, sun.elevationDeg), 0.0);
  const shading::View view = shading::viewOf(sky.state());
  const LiveOptions options{.flare = 0.01f};
  sky.draw(view, target, options);
  const long before = gAllocations;
  // Mesa's own allocations are plain malloc.
  for (int i = 0; i < 3; ++i) sky.draw(view, target, options);
  EXPECT_EQ(gAllocations - before, 0);
}

// The eye climbs through three key heights of the air (SkyTableKeys), and two views are drawn from elsewhere.
TEST_F(LiveSkyTest, ClimbsAllocateNothing) {
  LiveSky sky;
  const scene::Scene s = thinScene();
  const auto frame = [&](int i) {
    sky.update(s, 0.5 * i);
    for (unsigned view = 0; view < 2; ++view) {
      shading::View from = shading::viewOf(sky.state());
      from.view = glm::translate(from.view, {0.0, 0.0, view == 0 ? -4.0 * i : -4000.0});
      sky.draw(from, target, {.view = view});
    }
  };
  for (int i = 0; i < 3; ++i) frame(i);
  const long before = gAllocations;
  for (int i = 3; i < 120; ++i) frame(i);
  EXPECT_EQ(gAllocations - before, 0);
}

// Through three key instants of the clear sky, a second at a time.
TEST_F(LiveSkyTest, UpdatesAllocateNothing) {
  LiveSky sky;
  const scene::Scene s = thinScene();
  sky.update(s, 0.0);
  sky.update(s, 1.0);
  drawn(sky);
  const long before = gAllocations;
  for (int second = 2; second < 100; ++second) sky.update(s, second);
  EXPECT_EQ(gAllocations - before, 0);
}

// So that no update has to make a key instant of the clear sky at once.
TEST_F(LiveSkyTest, TheNextKeyInstantIsReadyBeforeItsTime) {
  LiveSky sky;
  const scene::Scene s = thinScene();
  sky.update(s, 0.0);
  for (double at = 0.5; at < 15.0; at += 0.5) sky.update(s, at);
  EXPECT_FALSE(sky.state().clearSkyAhead);
  for (double at = 15.0; at < 29.0; at += 0.5) sky.update(s, at);
  ASSERT_TRUE(sky.state().clearSkyAhead);
  EXPECT_EQ(sky.state().clearSkyAhead->atS, 60.0);
  // Backwards as well.
  for (double at = 29.0; at > 0.5; at -= 0.5) sky.update(s, at);
  ASSERT_TRUE(sky.state().clearSkyAhead);
  EXPECT_EQ(sky.state().clearSkyAhead->atS, -30.0);
}

// Whatever way led there: on, back, over key instants and over a sunset at which the moon takes the clouds.
TEST_F(LiveSkyTest, AnyWayToAnInstantGivesItsFrame) {
  for (const double sunElevationDeg : {35.0, 0.0}) {
    scene::Scene s = thinScene(sunElevationDeg);
    LiveSky walking;
    walking.update(s, -40.0);
    for (const double at : {-20.0, -3.0, 11.0, 29.0, 31.0, 64.0, 45.0, 8.0, 7.0, 1200.0, 1201.0, 1195.0}) {
      walking.update(s, at);
      LiveSky direct;
      direct.update(s, at);
      EXPECT_EQ(drawn(walking).data, drawn(direct).data) << sunElevationDeg << " degrees, " << at << " s";
    }
  }
}

TEST_F(LiveSkyTest, ComposingOctavesAllocatesNothing) {
  for (const auto kernel :
       {scene::OctaveKernel::kGradient, scene::OctaveKernel::kPallister, scene::OctaveKernel::kCourse}) {
    scene::Sheet sheet;
    sheet.pattern = scene::SheetPattern::kOctaves;
    sheet.living.kernel = kernel;
    sheet.texels = 64;
    sheet.octaves = 3;
    OctavesPass pass;
    LivingTexture living(sheet, 1);
    gpu::Texture2D pattern(64, 64, {.format = gpu::Format::kR16F, .filter = gpu::Filter::kMipmap});
    pass.prepare(living);
    pass.compose(living, 0.0, pattern);
    const long before = gAllocations;
    for (int i = 1; i < 50; ++i) pass.compose(living, 40.0 * i, pattern);
    EXPECT_EQ(gAllocations - before, 0);
  }
}

// A sky with volumes, and a sheet among them.
scene::Scene marchedScene() {
  scene::Scene s = cloudyScene(35.0, {Genus::kCumulus, Genus::kCirrus});
  s.layers[1].technique = scene::Technique::kSkyPlane;
  s.output.width = 64;
  s.output.height = 36;
  return s;
}

// A sky of metaballs from the library, with a sheet over them.
scene::Scene heapedScene() {
  scene::Scene s = cloudyScene(35.0, {Genus::kCumulus, Genus::kCirrus});
  s.layers[0].oktas = 1.0;
  s.layers[0].technique = scene::Technique::kMetaballs;
  s.layers[1].technique = scene::Technique::kSkyPlane;
  s.output.width = 64;
  s.output.height = 36;
  return s;
}

// As stills draw them, but for what light is sampled at.
TEST_F(LiveSkyTest, DrawsMetaballsAsStillsDo) {
  const scene::Scene s = heapedScene();
  LiveSky sky;
  sky.update(s, 0.0);
  const Image<float> live = drawn(sky);
  EXPECT_EQ(firstBadValue(live), -1);
  scene::Scene clear = s;
  clear.layers.erase(clear.layers.begin());
  sky.update(clear, 0.0);
  EXPECT_GT(relativeDifference(drawn(sky), live), 0.02);
  const Image<float> still = SkyRenderer().draw(scene::buildSky(s, 0.0)).luminance;
  context.makeCurrent();
  EXPECT_LT(relativeDifference(live, still), 0.1);
}

// Relit by every hour, and whatever was drawn before.
TEST_F(LiveSkyTest, AFrameWithMetaballsIsTheSameFirstOrAfterOthers) {
  const scene::Scene s = heapedScene();
  LiveSky first;
  first.update(s, 100.0);
  const Image<float> expected = drawn(first);
  LiveSky other;
  other.update(s, 0.0);
  drawn(other);
  other.update(s, 7200.0);
  EXPECT_GT(relativeDifference(drawn(other), expected), 0.1);
  other.update(s, 100.0);
  EXPECT_EQ(drawn(other).data, expected.data);
}

// A thin sheet beside metaballs leaves the light that these let through as it is.
TEST_F(LiveSkyTest, SheetsBesideMetaballsKeepTheirLight) {
  scene::Scene s = heapedScene();
  s.layers[0].oktas = 6.0;
  s.layers[1].oktas = 0.5;
  const auto ambientOf = [](const scene::Scene& scene) {
    LiveSky sky;
    sky.update(scene, 0.0);
    return sky.state().ambient;
  };
  const scene::AmbientLight with = ambientOf(s);
  s.layers.pop_back();
  const scene::AmbientLight alone = ambientOf(s);
  EXPECT_NEAR(with.air.clearAir, alone.air.clearAir, 0.15f * alone.air.clearAir);
  EXPECT_NEAR(with.skyOnGround.y, alone.skyOnGround.y, 0.15f * alone.skyOnGround.y);
}

// By night there is the most to bind.
TEST_F(LiveSkyTest, AnEngineFindsItsStateAgainAtNight) {
  LiveSky sky;
  const ForeignEngine engine;
  const auto before = engine.state();
  scene::Scene s = moonlitScene();
  s.layers = heapedScene().layers;
  s.layers.push_back(s.layers[0]);
  s.layers[2].technique = scene::Technique::kVolume;
  sky.update(s, 0.0);
  sky.draw(shading::viewOf(sky.state()), gpu::Target(engine.framebuffer(), {0, 0, 16, 8}), {.scale = 1.0f});
  EXPECT_EQ(engine.state(), before);
}

TEST_F(LiveSkyTest, AnEngineFindsItsStateAgainAfterMetaballs) {
  LiveSky sky;
  const ForeignEngine engine;
  const auto before = engine.state();
  scene::Scene s = heapedScene();
  for (int i = 0; i < 3; ++i) {
    s.layers[1].technique = i < 2 ? scene::Technique::kSkyPlane : scene::Technique::kVolume;
    sky.update(s, 10.0 * i);
    EXPECT_EQ(engine.state(), before);
    sky.draw(shading::viewOf(sky.state()), gpu::Target(engine.framebuffer(), {0, 0, 16, 8}),
             {.scale = 1e-4f, .flare = 0.01f});
    EXPECT_EQ(engine.state(), before);
  }
}

// Time runs, the eye flies and looks about.
TEST_F(LiveSkyTest, FramesWithMetaballsAllocateNothing) {
  LiveSky sky;
  const scene::Scene s = heapedScene();
  shading::View view = shading::viewOf(scene::buildSky(s, 0.0));
  const auto frame = [&](int i) {
    sky.update(s, 0.5 * i);
    view.view[3].x += 20.0;
    view.view[3].y -= 10.0;
    sky.draw(view, target, {.scale = 1e-4f});
  };
  for (int i = 0; i < 3; ++i) frame(i);
  const long before = gAllocations;
  for (int i = 3; i < 16; ++i) frame(i);
  EXPECT_EQ(gAllocations - before, 0);
}

// Four oktas to the horizon, the eye moving: a frame, and the same as a still.
TEST_F(LiveSkyTest, DISABLED_CostOfMetaballs) {
  scene::Scene s = looking(cloudyScene(35.0, {Genus::kCumulus}, 4.0), 285.0, 14.0, 75.0);
  s.technique = scene::Technique::kMetaballs;
  SkyRenderer stills;
  for (const int height : {360, 540}) {
    s = sized(s, height * 16 / 9, height);
    const scene::SkyState state = scene::buildSky(s, 0.0);
    std::vector<double> live, still;
    context.makeCurrent();
    {
      LiveSky sky;
      sky.update(s, 0.0);
      shading::View view = shading::viewOf(state);
      const gpu::Texture2D picture(height * 16 / 9, height, {.format = gpu::Format::kRgba16F});
      const gpu::Framebuffer to(picture);
      for (int i = 0; i <= 5; ++i) {
        view.view[3].x += 5.0;
        gpu::Stopwatch watch;
        sky.draw(view, to);
        if (i > 0) live.push_back(watch.finishedMs());  // the first compiles
      }
    }
    for (int i = 0; i <= 3; ++i) {
      const auto start = std::chrono::steady_clock::now();
      stills.draw(state);
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
      if (i > 0) still.push_back(took.count());
    }
    context.makeCurrent();
    std::ranges::sort(live);
    std::ranges::sort(still);
    std::cout << height << " lines: live " << live[2] << " ms, still " << still[1] << " ms\n";
  }
}

// As in stills, a cloud over the eye darkens the ground.
TEST_F(LiveSkyTest, MetaballsShadeTheGround) {
  const MetaballFolder folder;
  scene::Scene s = fromHeight(looking(clearScene(80.0), 0.0, -90.0, 20.0), 300.0);
  s.output.width = 64;
  s.output.height = 36;
  LiveSky sky;
  sky.update(s, 0.0);
  const double open = luminanceOf(meanOf(drawn(sky)));
  s.metaballs.push_back(folder.ball(900.0, 0.05, {0.0, 0.0, 2500.0}));
  sky.update(s, 0.0);
  const Image<float> shaded = drawn(sky);
  EXPECT_LT(luminanceOf(meanOf(shaded)), 0.6 * open);
  const Image<float> still = SkyRenderer().draw(sky.state()).luminance;
  context.makeCurrent();
  EXPECT_LT(relativeDifference(shaded, still), 0.05);
}

TEST_F(LiveSkyTest, AnEngineFindsItsStateAgainAfterAMarch) {
  LiveSky sky;
  const ForeignEngine engine;
  const auto before = engine.state();
  sky.update(marchedScene(), 0.0);
  EXPECT_EQ(engine.state(), before);
  for (int i = 0; i < 3; ++i) {
    sky.draw(shading::viewOf(sky.state()), gpu::Target(engine.framebuffer(), {0, 0, 16, 8}),
             {.scale = 1e-4f, .flare = 0.01f});
    EXPECT_EQ(engine.state(), before);
    sky.update(marchedScene(), i + 1.0);
    EXPECT_EQ(engine.state(), before);
  }
}

// Time runs, the eye turns and flies; the light volume is swept twice.
TEST_F(LiveSkyTest, MarchedFramesAllocateNothing) {
  LiveSky sky;
  const scene::Scene s = marchedScene();
  shading::View view = shading::viewOf(scene::buildSky(s, 0.0));
  const auto frame = [&](int i) {
    sky.update(s, 0.25 * i);
    view.view[3].x += 20.0;
    view.view[3].y -= 10.0;
    sky.draw(view, target, {.scale = 1e-4f});
  };
  for (int i = 0; i < 3; ++i) frame(i);
  const long before = gAllocations;
  for (int i = 3; i < 3 + 2 * LiveVolumes::kFramesOfSweep; ++i) frame(i);
  EXPECT_EQ(gAllocations - before, 0);
}

// The scene's own eye is for pictures; engines have theirs.
TEST_F(LiveSkyTest, TheAirIsThatOfTheView) {
  for (const scene::Scene& low : {clearScene(30.0), clearScene(-3.0), marchedScene(), thinScene()}) {
    const scene::Scene high = fromHeight(looking(sized(low, 64, 36), 120.0, 15.0), 9000.0);
    LiveSky own, other;
    own.update(high, 0.0);
    other.update(fromHeight(high, 2.0), 0.0);
    const shading::View view = shading::viewOf(own.state());
    const auto drawnBy = [&](LiveSky& sky) {
      for (int i = 0; i < 70; ++i) sky.draw(view, target);
      return target.readPicture(0, 3);
    };
    const Image<float> expected = drawnBy(own), picture = drawnBy(other);
    EXPECT_LT(relativeDifference(picture, expected), 1e-3);
    // As a still has it, which takes tables of its very height.
    const double still = luminanceOf(meanOf(SkyRenderer().draw(own.state()).luminance));
    EXPECT_NEAR(luminanceOf(meanOf(picture)) / still, 1.0, 0.03);
  }
}

// As an engine's sliders have it.
TEST_F(LiveSkyTest, CameraAndExposureKeepTheSky) {
  LiveSky sky;
  scene::Scene s = marchedScene();
  sky.update(s, 10.0);
  const auto air = sky.state().atmosphere;
  const shading::View view = shading::viewOf(sky.state());
  s.output.exposureEv = 12.0;
  s.output.width = 640;
  s.camera.pitchDeg = 33.0;
  s.atS = 5.0;
  sky.update(s, 10.0);
  EXPECT_EQ(sky.state().atmosphere, air);
  EXPECT_EQ(sky.state().scene, s);
  EXPECT_NE(shading::viewOf(sky.state()).view, view.view);
  s.output.sunDisc = false;
  sky.update(s, 10.0);
  EXPECT_FALSE(sky.state().scene.output.sunDisc);
  EXPECT_EQ(sky.state().atmosphere, air);
  s.camera.fovDeg = 500.0;
  EXPECT_THROW(sky.update(s, 10.0), ParameterError);
  s.camera.fovDeg = 70.0;
  s.output.quality = scene::Quality::kHigh;
  sky.update(s, 10.0);
  EXPECT_NE(sky.state().atmosphere, air);
}

// Nor where time comes to key instants of cover.
TEST_F(LiveSkyTest, UpdatesWithVolumesAllocateNothing) {
  LiveSky sky;
  const scene::Scene s = marchedScene();
  sky.update(s, 0.0);
  const double step = sky.state().coverKeyS / 20.0;
  ASSERT_GT(step, 0.0);
  sky.update(s, step);
  drawn(sky);
  const long before = gAllocations;
  for (int i = 2; i < 50; ++i) sky.update(s, i * step);
  EXPECT_EQ(gAllocations - before, 0);
  EXPECT_EQ(sky.state().calibration, scene::buildSky(s, 49 * step).calibration);
}

// Neither in what is uploaded nor in what is drawn.
TEST_F(LiveSkyTest, AnEnginesStateDoesNotShow) {
  for (const scene::Scene& s : {thinScene(), heapedScene(), marchedScene()}) {
    Image<float> expected;
    {
      LiveSky sky;
      sky.update(s, 0.0);
      expected = drawn(sky);
    }
    target.clear();
    {
      const ForeignEngine engine;
      LiveSky sky;
      sky.update(s, 0.0);
      sky.draw(shading::viewOf(sky.state()), target);
    }
    EXPECT_EQ(target.readPicture(0, 3).data, expected.data);
  }
}

// An engine that has its pictures in sRGB finds linear light in them.
TEST_F(LiveSkyTest, SrgbTargetsAreEncoded) {
  for (const scene::Scene& s : {thinScene(), marchedScene(), heapedScene()}) {
    LiveSky sky;
    sky.update(s, 0.0);
    const shading::View view = shading::viewOf(sky.state());
    const LiveOptions options{.scale = 2e-5f};
    sky.draw(view, target, options);
    const double linear = static_cast<double>(meanOf(target.readPicture(0, 3)).y);
    ASSERT_LT(linear, 0.6);
    const SrgbTarget encoded;
    sky.draw(view, {encoded.framebuffer(), {0, 0, 64, 36}}, options);
    EXPECT_NEAR(encoded.meanGreen(), linear, 0.03 * linear);
  }
}

// Only the clouds, over what an engine has drawn.
TEST_F(LiveSkyTest, WithoutABackdropWhatIsThereShowsThrough) {
  scene::Scene s = thinScene();
  s.sheets.clear();
  s.layers.resize(1);
  s.layers[0].oktas = 4.0;
  s.camera.pitchDeg = 45.0;
  LiveSky sky;
  sky.update(s, 0.0);
  target.clear(0, {1e7f, 1e7f, 1e7f, 1.0f});
  sky.draw(shading::viewOf(sky.state()), target, {.backdrop = false});
  const Image<float> got = target.readPicture(0, 3);
  int untouched = 0;
  for (std::size_t i = 0; i < got.data.size(); i += 3) untouched += got.data[i] == 1e7f;
  EXPECT_GT(untouched, 64 * 36 / 10);
  EXPECT_LT(untouched, 64 * 36 * 9 / 10);
}

}  // namespace
}  // namespace welkin::render
