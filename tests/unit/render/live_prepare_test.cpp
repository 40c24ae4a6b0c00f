// SPDX-License-Identifier: Apache-2.0
// A sky in somebody's frame loop: what is made ready before its first frame.
#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <string>

#include "tests/testing/foreign_engine.h"
#include "tests/testing/gl_counts.h"
#include "tests/testing/skies.h"
#include "welkin/core/error.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

scene::Scene sceneOf(int kind, double sunElevationDeg = 35.0) {
  scene::Scene s = cloudyScene(sunElevationDeg, {Genus::kCumulus, Genus::kCirrus});
  s.layers[1].technique = scene::Technique::kSkyPlane;
  if (kind == 0) s.layers[0].technique = scene::Technique::kSkyPlane;
  if (kind == 2) s.layers[0].technique = scene::Technique::kMetaballs;
  return sized(s, 64, 36);
}
constexpr const char* kKinds[] = {"sheets", "volumes", "metaballs"};

// By day, and where night falls: it has programs of its own.
TEST(LivePrepareTest, TheFirstDrawMakesNothing) {
  gpu::Context context{{.debug = true}};
  const gpu::Texture2D picture(64, 36, {.format = gpu::Format::kRgba16F});
  const gpu::Framebuffer to(picture);
  for (int kind = 0; kind < 3; ++kind) {
    const scene::Scene s = sceneOf(kind);
    LiveSky sky;
    sky.update(s, 0.0);
    const shading::View view = shading::viewOf(sky.state());
    constexpr LiveOptions kOptions{.scale = 1e-3f, .flare = 0.01f};
    sky.prepare(view, to, kOptions);
    const GlCounts counts;
    for (int i = 0; i < 3; ++i) {
      sky.update(s, i / 60.0);
      sky.draw(view, to, kOptions);
      EXPECT_EQ(counts.programs(), 0) << kKinds[kind] << ", frame " << i;
      EXPECT_EQ(counts.textures(), 0) << kKinds[kind] << ", frame " << i;
    }
    sky.update(s, 10.0 * 3600.0);
    sky.draw(view, to, kOptions);
    EXPECT_EQ(counts.programs(), 0) << kKinds[kind] << " by night";
  }
  for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
}

// What the test above counts is there without prepare().
TEST(LivePrepareTest, OtherwiseItMakesProgramsAndTextures) {
  const gpu::Context context;
  const gpu::Texture2D picture(64, 36, {.format = gpu::Format::kRgba16F});
  const gpu::Framebuffer to(picture);
  LiveSky sky;
  sky.update(sceneOf(1), 0.0);
  const GlCounts counts;
  sky.draw(shading::viewOf(sky.state()), to);
  EXPECT_GT(counts.programs(), 0);
  EXPECT_GT(counts.textures(), 0);
}

TEST(LivePrepareTest, LeavesTheTargetAsItIsAndFramesToo) {
  const gpu::Context context;
  const gpu::Texture2D picture(64, 36, {.format = gpu::Format::kRgba32F});
  gpu::Framebuffer to(picture);
  for (int kind = 0; kind < 3; ++kind) {
    LiveSky plain, sky;
    plain.update(sceneOf(kind), 0.0);
    sky.update(sceneOf(kind), 0.0);
    const shading::View view = shading::viewOf(sky.state());
    to.clear();
    sky.prepare(view, to, {.flare = 0.01f});
    for (const float v : to.readPicture(0, 4).data) ASSERT_EQ(v, 0.0f) << kKinds[kind];
    if (kind == 1) continue;  // whose frames come to the same in some frames
    sky.draw(view, to);
    const Image<float> prepared = to.readPicture(0, 3);
    plain.draw(view, to);
    EXPECT_EQ(prepared.data, to.readPicture(0, 3).data) << kKinds[kind];
  }
}

TEST(LivePrepareTest, AnEngineFindsItsStateAgain) {
  const gpu::Context context;
  const ForeignEngine engine;
  const auto before = engine.state();
  for (int kind = 0; kind < 3; ++kind) {
    LiveSky sky;
    sky.update(sceneOf(kind), 0.0);
    sky.prepare(shading::viewOf(sky.state()), gpu::Target(engine.framebuffer(), {0, 0, 16, 8}),
                {.flare = 0.01f});
    EXPECT_EQ(engine.state(), before) << kKinds[kind];
  }
}

TEST(LivePrepareTest, NeedsASky) {
  const gpu::Context context;
  const gpu::Texture2D picture(64, 36, {.format = gpu::Format::kRgba16F});
  const gpu::Framebuffer to(picture);
  LiveSky sky;
  EXPECT_THROW(sky.prepare(shading::View{}, to), ParameterError);
}

TEST(LivePrepareTest, DISABLED_CostOfTheFirstFrame) {
  const gpu::Context context;
  const LiveSky warm;
  for (int kind = 0; kind < 3; ++kind)
    for (const bool prepared : {false, true}) {
      const gpu::Texture2D picture(640, 360, {.format = gpu::Format::kRgba16F});
      const gpu::Framebuffer to(picture);
      const scene::Scene s = sized(sceneOf(kind), 640, 360);
      gpu::Stopwatch watch;
      LiveSky sky;
      const double made = watch.finishedMs();
      sky.update(s, 0.0);
      const double updated = watch.finishedMs();
      const shading::View view = shading::viewOf(sky.state());
      if (prepared) sky.prepare(view, to, {.flare = 0.01f});
      const double ready = watch.finishedMs();
      std::cout << kKinds[kind] << (prepared ? ", prepared" : "") << ": made " << made << " ms, first update "
                << updated << ", prepared " << ready << ", frames";
      const GlCounts counts;
      for (int i = 0; i < 4; ++i) {
        sky.update(s, i / 60.0);
        sky.draw(view, to, {.flare = 0.01f});
        std::cout << ' ' << watch.finishedMs();
        if (i == 0)
          std::cout << " (" << counts.programs() << " programs, " << counts.textures() << " textures)";
      }
      std::cout << " ms\n";
    }
}

}  // namespace
}  // namespace welkin::render
