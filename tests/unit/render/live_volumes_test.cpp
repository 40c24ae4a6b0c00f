// SPDX-License-Identifier: Apache-2.0
// Marched clouds in somebody's frame loop, against the still.
#include "welkin/render/live_volumes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/testing/foreign_engine.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/sky_renderer.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

constexpr int kWidth = 96, kHeight = 54, kRound = LiveVolumes::kFramesInRound;

class LiveVolumesTest : public ::testing::Test {
 protected:
  void TearDown() override {
    context.makeCurrent();
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  static scene::Scene cumulus() {
    return looking(sized(cloudyScene(40.0, {Genus::kCumulus}), kWidth, kHeight), 200.0, 14.0);
  }
  Image<float> still(const scene::Scene& s, double seconds = 0.0) {
    Image<float> picture = SkyRenderer().draw(scene::buildSky(s, seconds)).luminance;
    context.makeCurrent();
    return picture;
  }
  static shading::View viewOf(const scene::Scene& s) { return shading::viewOf(scene::buildSky(s, 0.0)); }
  Image<float> after(LiveSky& sky, const shading::View& view, int frames, unsigned number = 0) {
    for (int i = 0; i < frames; ++i) sky.draw(view, target, {.view = number});
    return target.readPicture(0, 3);
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{kWidth, kHeight, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
};

// A pixel in motion is one sample: were that taken elsewhere in the pixel each round, the row that the
// horizon crosses would be dotted, some of its pixels ground and their neighbours sky.
TEST_F(LiveVolumesTest, InMotionTheHorizonIsALine) {
  const scene::Scene s = looking(cumulus(), 200.0, 14.2);  // the horizon in the middle of a row
  const std::array<shading::View, 2> views = {viewOf(s), viewOf(looking(s, 200.001, 14.2))};
  LiveSky sky;
  sky.update(s, 0.0);
  for (int i = 0; i < 2 * kRound + kRound / 2; ++i) after(sky, views[i % 2], 1);
  const Image<float> picture = target.readPicture(0, 3);
  for (int y = kHeight / 2; y < kHeight; ++y) {
    double sum = 0.0, bends = 0.0;
    for (int x = 1; x + 1 < kWidth; ++x) {
      sum += picture.at(x, y, 1);
      bends += std::abs(picture.at(x - 1, y, 1) - 2.0f * picture.at(x, y, 1) + picture.at(x + 1, y, 1));
    }
    EXPECT_LT(bends, 0.2 * sum) << "row " << y;
  }
}

// From the ground, in the air over a layer, and through a sheet between volumes.
TEST_F(LiveVolumesTest, AViewThatStaysConvergesToTheStill) {
  scene::Scene mixed = cumulus();
  mixed.layers.push_back(weather::typicalLayer(Genus::kCirrus, kTestLatitudeDeg));
  mixed.layers.back().technique = scene::Technique::kSkyPlane;
  std::vector<scene::Scene> scenes = {
      cumulus(),
      looking(sized(fromHeight(cloudyScene(30.0, {Genus::kStratocumulus}, 6.0), 3500.0), kWidth, kHeight),
              90.0, -12.0),
      mixed};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    SCOPED_TRACE(i);
    scenes[i].output.quality = scene::Quality::kHigh;  // for a still with little noise of its own
    const Image<float> expected = still(scenes[i]);
    LiveSky sky;
    sky.update(scenes[i], 0.0);
    const shading::View view = viewOf(scenes[i]);
    const double first = relativeDifference(after(sky, view, 1), expected);
    const double round = relativeDifference(after(sky, view, kRound - 1), expected);
    const double last = relativeDifference(after(sky, view, 15 * kRound), expected);
    EXPECT_LT(first, 0.12);
    EXPECT_LT(round, first);
    EXPECT_LT(last, round);
    EXPECT_LT(last, 0.025);
    EXPECT_EQ(firstBadValue(target.readPicture(0, 3)), -1);
  }
}

// After all rounds nothing changes any more, and what was seen before is forgotten.
TEST_F(LiveVolumesTest, WhatItConvergesToKnowsNoPast) {
  const scene::Scene s = cumulus();
  const shading::View view = viewOf(s);
  constexpr int kAll = (LiveVolumes::kRounds + 2) * kRound;
  LiveSky direct;
  direct.update(s, 100.0);
  const Image<float> expected = after(direct, view, kAll);
  EXPECT_EQ(after(direct, view, 3).data, expected.data);

  LiveSky walking;
  walking.update(s, 0.0);
  after(walking, viewOf(looking(s, 20.0, 30.0)), 20);
  for (int second = 80; second <= 100; ++second) {
    walking.update(s, second);
    after(walking, view, 1);
  }
  EXPECT_LT(relativeDifference(after(walking, view, kAll), expected), 0.0005);
}

// After a turn nothing of the other side is left: the picture is about as good as one that began there, from
// the first frame on, whether the two sides overlap or not.
TEST_F(LiveVolumesTest, ASuddenTurnLeavesNoGhosts) {
  const scene::Scene s = cumulus();
  for (const double headingDeg : {225.0, 290.0}) {
    SCOPED_TRACE(headingDeg);
    const scene::Scene other = looking(s, headingDeg, 10.0);
    const Image<float> expected = still(other);
    LiveSky beginning, turning;
    beginning.update(s, 0.0);
    turning.update(s, 0.0);
    const double before = relativeDifference(after(turning, viewOf(s), 4 * kRound), expected);
    double all = 0.0, allFresh = 0.0;  // single frames differ, as they march other pixels first
    for (const int frames : {1, 7, 8, 16}) {
      const double turned = relativeDifference(after(turning, viewOf(other), frames), expected);
      EXPECT_LT(turned, 0.4 * before) << frames;
      all += turned;
      allFresh += relativeDifference(after(beginning, viewOf(other), frames), expected);
    }
    EXPECT_LT(all, 1.2 * allFresh);
  }
}

// A turn as an engine makes it, a quarter of a pixel a frame: the picture stays near the truth all along,
// nearer than one sample in each block shows it.
TEST_F(LiveVolumesTest, ASlowTurnKeepsWhatItSaw) {
  const scene::Scene s = cumulus();
  LiveSky turning, fresh;
  turning.update(s, 0.0);
  fresh.update(s, 0.0);
  double kept = 0.0, alone = 0.0;
  for (int i = 0; i <= 48; ++i) {
    const scene::Scene now = looking(s, 200.0 + 0.18 * i, 14.0);
    const Image<float> frame = after(turning, viewOf(now), 1);
    if (i < 16 || i % 16 != 0) continue;
    // Views never drawn before.
    const auto number = static_cast<unsigned>(i);
    const Image<float> first = after(fresh, viewOf(now), 1, number);
    const Image<float> expected = after(fresh, viewOf(now), 8 * kRound, number);
    kept += relativeDifference(frame, expected);
    alone += relativeDifference(first, expected);
  }
  EXPECT_LT(kept, 0.75 * alone);
}

// While time runs, pictures stay near the still of the instant.
TEST_F(LiveVolumesTest, RunningTimeIsFollowed) {
  scene::Scene s = cumulus();
  s.layers[0].windSpeedMps = 20.0;
  LiveSky sky;
  const shading::View view = viewOf(s);
  for (int i = 0; i <= 100; ++i) {
    sky.update(s, 0.5 * i);
    after(sky, view, 1);
  }
  const Image<float> frame = target.readPicture(0, 3);
  const double now = relativeDifference(frame, still(s, 50.0)),
               past = relativeDifference(frame, still(s, 30.0));
  EXPECT_LT(now, 0.08);
  EXPECT_LT(now, 0.7 * past);
}

// Where clouds close a gap nothing is darker than all around it in the still: light and transmittance change
// together.
TEST_F(LiveVolumesTest, WhereGapsCloseNothingIsBlack) {
  scene::Scene s =
      looking(sized(fromHeight(cloudyScene(30.0, {Genus::kCumulus}), 4000.0), kWidth, kHeight), 200.0, -20.0);
  s.layers[0].windSpeedMps = 20.0;
  const Image<float> expected = still(s, 5.0);
  LiveSky sky;
  int dark = 0;
  for (int i = 0; i <= 50; ++i) {
    sky.update(s, 0.1 * i);
    after(sky, viewOf(s), 1);
    if (i < 30) continue;
    const Image<float> frame = target.readPicture(0, 3);
    for (int y = 2; y < kHeight - 2; ++y)
      for (int x = 2; x < kWidth - 2; ++x) {
        float around = 1e9f;
        for (int v = y - 2; v <= y + 2; ++v)
          for (int u = x - 2; u <= x + 2; ++u) around = std::min(around, expected.at(u, v));
        dark += frame.at(x, y) < 0.6f * around;
      }
  }
  EXPECT_EQ(dark, 0);
}

// A plane over the eye, though the order is that of an eye above everything.
TEST_F(LiveVolumesTest, PlanesAreMetFromBelow) {
  scene::Scene s = cumulus();
  s.layers[0].oktas = 1.0;
  scene::Sheet plane;
  plane.surface = scene::SheetSurface::kPlane;
  plane.heightM = 4000.0;
  plane.oktas = 8.0;
  s.sheets = {plane};
  LiveSky sky;
  sky.update(s, 0.0);
  const Image<float> live = after(sky, viewOf(s), 2 * kRound);
  EXPECT_LT(relativeDifference(live, still(s)), 0.06);
  s.sheets.clear();
  EXPECT_GT(relativeDifference(live, still(s)), 0.2);
}

// Time leaps while view 0 is not drawn.
TEST_F(LiveVolumesTest, EveryViewIsLitByTheLightOfItsTime) {
  const scene::Scene s = cumulus();
  const shading::View view = viewOf(s);
  LiveSky leaping, fresh;
  leaping.update(s, 0.0);
  after(leaping, view, 2, 1);
  leaping.update(s, 4.0 * 3600.0);
  fresh.update(s, 4.0 * 3600.0);
  EXPECT_LT(relativeDifference(after(leaping, view, 4 * kRound, 1), after(fresh, view, 4 * kRound, 1)),
            0.005);
}

// Each view has a memory of its own.
TEST_F(LiveVolumesTest, ViewsDoNotDisturbEachOther) {
  const scene::Scene s = cumulus();
  const shading::View view = viewOf(s), other = viewOf(looking(s, 20.0, 30.0));
  LiveSky alone, both;
  alone.update(s, 0.0);
  both.update(s, 0.0);
  for (int i = 0; i < 20; ++i) {
    after(both, view, 1, 0);
    after(both, other, 1, 1);
  }
  EXPECT_EQ(after(both, view, 1, 0).data, after(alone, view, 21, 0).data);
}

// A minimised window has no pixels.
TEST_F(LiveVolumesTest, AnEmptyAreaIsNoError) {
  const scene::Scene s = cumulus();
  const shading::View view = viewOf(s);
  LiveSky sky, other;
  sky.update(s, 0.0);
  other.update(s, 0.0);
  const Image<float> before = after(sky, view, 1);
  for (const auto& [width, height] : {std::pair{0, 0}, {0, 9}, {16, 0}})
    EXPECT_NO_THROW(sky.draw(view, gpu::Target(target.id(), {0, 0, width, height}), {.flare = 0.01f}));
  EXPECT_EQ(target.readPicture(0, 3).data, before.data);
  after(other, view, 1);
  EXPECT_EQ(after(sky, view, 1).data, after(other, view, 1).data);
}

// An engine's ground may lie lower than the sky's. In haze half of the sky has the shadows of its clouds.
TEST_F(LiveVolumesTest, AnEyeBelowTheGroundSeesTheSameAir) {
  scene::Scene s = looking(sized(cloudyScene(25.0, {Genus::kCumulus}, 6.0), kWidth, kHeight), 90.0, 4.0);
  s.visibilityM = 5000.0;
  const auto from = [&](double eyeM) {
    shading::View view = viewOf(s);
    view.view[3] = view.view * glm::dvec4(0.0, 0.0, s.camera.eyeM - eyeM, 1.0);
    LiveSky sky;
    sky.update(s, 0.0);
    return after(sky, view, 4 * kRound);
  };
  const Image<float> above = from(0.05);
  for (const auto& [eyeM, most] : {std::pair{-0.05, 0.003}, {-2.0, 0.012}}) {
    const Image<float> below = from(eyeM);
    EXPECT_EQ(firstBadValue(below), -1);
    EXPECT_LT(relativeDifference(below, above), most) << eyeM;
  }
}

// The shadows of clouds on the ground are those of the still, though drawn elsewhere.
TEST_F(LiveVolumesTest, TheGroundIsShaded) {
  const scene::Scene s = looking(
      sized(fromHeight(cloudyScene(50.0, {Genus::kCumulus}, 3.0), 400.0), kWidth, kHeight), 90.0, -40.0);
  scene::Scene clear = s;
  clear.layers.clear();
  LiveSky sky;
  sky.update(s, 0.0);
  const Image<float> live = after(sky, viewOf(s), 2 * kRound);
  EXPECT_LT(relativeDifference(live, still(s)), 0.02);
  EXPECT_GT(relativeDifference(live, still(clear)), 0.1);
}

}  // namespace
}  // namespace welkin::render
