// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs in stills.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/testing/metaball_scene.h"
#include "tests/testing/pictures.h"
#include "tests/testing/scratch_folder.h"
#include "tests/testing/skies.h"
#include "welkin/core/error.h"
#include "welkin/gpu/context.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/cumulus_library.h"
#include "welkin/scene/metaball_file.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

class SkySplatsTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : renderer.takeErrors()) ADD_FAILURE() << error;
  }

  // A thick round cloud, north, its middle at that height and at eye level 4 km away, or as near as told.
  scene::MetaballCloud cloudAt(double heightM, double northM = 4000.0, double radiusM = 900.0) {
    const std::filesystem::path path = folder / "ball.json";
    std::ofstream(path) << scene::metaballText({{{{{{0.0, 0.0, 0.0}, radiusM, 1.0}}, {}, {}}}});
    scene::MetaballCloud cloud;
    cloud.file = path.string();
    cloud.positionM = {0.0, northM, heightM};
    return cloud;
  }
  Image<float> drawn(const scene::Scene& s) { return renderer.draw(scene::buildSky(s, 0.0)).luminance; }

  // What a cloud changes in a picture, if it is black.
  double seen(scene::Scene s, scene::MetaballCloud cloud) {
    cloud.albedo = 0.0;
    s.metaballs = {cloud};
    s.metaballs[0].positionM = {0.0, -190000.0, 0.0};  // behind the eye and the horizon
    const Image<float> without = drawn(s);
    s.metaballs = {cloud};
    return relativeDifference(drawn(s), without);
  }

  ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path();
  SkyRenderer renderer{{.debug = true}};
};

// An opaque sheet or deck hides the clouds behind it and none before it.
TEST_F(SkySplatsTest, HaveTheirPlaceAmongSheetsAndVolumes) {
  const double pitchDeg = 45.0;
  scene::Scene sheet = looking(clearScene(50.0), 0.0, pitchDeg);
  sheet.sheets.emplace_back();
  sheet.sheets[0].heightM = 2500.0;
  sheet.sheets[0].texels = 32;
  sheet.sheets[0].octaves = 1;
  sheet.sheets[0].cutoff = 0.0;
  sheet.sheets[0].density = 0.01;
  sheet.sheets[0].bias = 1.0;
  const scene::Scene deck = looking(cloudyScene(50.0, {Genus::kStratus}, 8.0), 0.0, pitchDeg);
  for (const scene::Scene& s : {sheet, deck}) {
    const bool isSheet = !s.sheets.empty();
    const double before = isSheet ? 1500.0 : 150.0, behind = 5000.0;
    EXPECT_GT(seen(s, cloudAt(before, before, 0.3 * before)), 0.02) << isSheet;
    EXPECT_LT(seen(s, cloudAt(behind, behind)), 0.002) << isSheet;
    // From above it is the other way round.
    const scene::Scene high = fromHeight(looking(s, 0.0, -pitchDeg), 9000.0);
    EXPECT_GT(seen(high, cloudAt(behind, 4000.0)), 0.02) << isSheet;
  }
}

// The ground hides what is below the horizon, and a cloud before the ground hides that.
TEST_F(SkySplatsTest, TheGroundIsBehindThem) {
  const scene::Scene s = fromHeight(looking(clearScene(50.0), 0.0, -20.0, 40.0), 3000.0);
  EXPECT_GT(seen(s, cloudAt(2000.0)), 0.05);
  const scene::Scene level = looking(clearScene(50.0), 0.0, 0.0, 10.0);
  EXPECT_GT(seen(level, cloudAt(500.0, 15000.0)), 0.01);
  EXPECT_LT(seen(level, cloudAt(500.0, 190000.0)), 1e-4);  // under the horizon
}

TEST_F(SkySplatsTest, AnEyeInABallSeesNothingElse) {
  scene::Scene s = fromHeight(looking(clearScene(50.0), 0.0, 0.0), 2000.0);
  s.metaballs = {cloudAt(2000.0, 10.0)};
  s.metaballs[0].phase = scene::MetaballPhase::kIsotropic;
  const Image<float> picture = drawn(s);
  double low = 1e30, high = 0.0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double l = luminanceOf(pixel(picture, x, y));
      ASSERT_TRUE(std::isfinite(l));
      low = std::min(low, l), high = std::max(high, l);
    }
  EXPECT_GT(low, 0.0);
  EXPECT_LT(high, 4.0 * low);  // no horizon, no sky
}

TEST_F(SkySplatsTest, TheOrderOfCloudsDoesNotMatter) {
  scene::Scene s = looking(clearScene(40.0), 0.0, 15.0);
  s.metaballs = {cloudAt(1500.0), cloudAt(1800.0, 5200.0)};
  s.metaballs[1].positionM.x = 500.0;
  scene::Scene turned = s;
  std::swap(turned.metaballs[0], turned.metaballs[1]);
  EXPECT_LT(relativeDifference(drawn(s), drawn(turned)), 1e-4);
}

// The faces of a cube show what the picture's own plane does.
TEST_F(SkySplatsTest, ProjectionsAgree) {
  scene::Scene s = clearScene(40.0);
  s.metaballs = {cloudAt(2500.0)};
  const double pitchDeg = std::atan2(2500.0, 4000.0) * 180.0 / 3.14159265358979;
  const Image<float> plane = drawn(sized(looking(s, 0.0, pitchDeg, 10.0), 16, 16));
  const Image<float> all = drawn(projected(looking(s, 0.0, 0.0), scene::Projection::kEquirect, 256, 128));
  const int y = static_cast<int>((90.0 - pitchDeg) / 180.0 * 128.0);
  const double inPlane = luminanceOf(pixel(plane, 8, 8)), inAll = luminanceOf(pixel(all, 128, y));
  EXPECT_NEAR(inAll / inPlane, 1.0, 0.05);
}

TEST_F(SkySplatsTest, TheGroundIsDarkInTheirShadow) {
  scene::Scene s = fromHeight(looking(clearScene(83.0), 0.0, -90.0, 20.0), 300.0);
  const double open = luminanceOf(meanOf(drawn(s)));
  s.metaballs = {cloudAt(2500.0, 0.0)};
  EXPECT_LT(luminanceOf(meanOf(drawn(s))), 0.6 * open);
}

// A cloud comes nearer, through all levels of detail, the picture following it: no step changes more than
// others.
TEST_F(SkySplatsTest, LevelsOfDetailFade) {
  const MetaballFolder files;
  const scene::LibraryCloud& tower = scene::cumulusTowers()[0];
  scene::Scene s = fromHeight(sized(clearScene(40.0), 24, 24), 8000.0);
  scene::MetaballCloud cloud =
      files.levels({tower.levels[0], tower.levels[1], tower.levels[2]}, {0.0, 0.0, 7600.0});
  cloud.scale = 800.0;
  cloud.extinctionPerM = 0.02;
  cloud.windFromDeg = 0.0;
  cloud.windSpeedMps = 100.0;
  constexpr double kFromM = 100000.0, kCloser = 0.97;
  cloud.positionM.y = kFromM;
  s.metaballs = {cloud};
  scene::SkyState state = scene::buildSky(s, 0.0);
  std::vector<double> changes;
  Image<float> before;
  bool coarsest = false, finest = false;
  for (double distanceM = kFromM; distanceM > 12000.0; distanceM *= kCloser) {
    scene::CloudBalls balls;
    state = scene::buildSky(s, (kFromM - distanceM) / cloud.windSpeedMps, &state);
    state.metaballs->at(state.secondsAfter, {0.0, 0.0, 8000.0}, state.clouds->earthRadiusM(), balls);
    coarsest |= balls.balls.size() == tower.levels[0].size();
    finest |= balls.balls.size() == tower.levels[2].size();
    scene::SkyState seen = state;
    seen.scene.camera.fovDeg = 2.0 * std::atan(700.0 / distanceM) * 180.0 / 3.14159265358979;
    seen.scene.camera.pitchDeg = -distanceM / 2.0 / 6371000.0 * 180.0 / 3.14159265358979;
    const Image<float> picture = renderer.draw(seen).luminance;
    if (!before.data.empty()) changes.push_back(relativeDifference(picture, before));
    before = picture;
  }
  EXPECT_TRUE(coarsest);
  EXPECT_TRUE(finest);
  const double most = *std::ranges::max_element(changes);
  std::ranges::sort(changes);
  EXPECT_GT(changes.front(), 0.0);
  EXPECT_LT(most, 3.0 * changes[changes.size() / 2]);
}

TEST_F(SkySplatsTest, SaysWhatIsWrong) {
  scene::Scene s = clearScene(40.0);
  s.metaballs.emplace_back();
  EXPECT_THROW(scene::validate(s), ParameterError);
  s.metaballs[0].file = (folder / "none.json").string();
  EXPECT_THROW(scene::buildSky(s, 0.0), IoError);
  std::ofstream(folder / "bad.json")
      << R"({"welkin": "metaballs", "balls": [{"center_m": [0, 0, 0], "radius_m": -1, "density": 1}]})";
  s.metaballs[0].file = (folder / "bad.json").string();
  EXPECT_THROW(scene::buildSky(s, 0.0), ParseError);
  // What marching does not know.
  s.metaballs = {cloudAt(1000.0)};
  for (const scene::MetaballRender as : {scene::MetaballRender::kSplats, scene::MetaballRender::kVolume}) {
    const bool marched = as == scene::MetaballRender::kVolume;
    scene::Scene dark = s, other = s;
    dark.metaballs[0].albedo = 0.9;
    other.metaballs[0].phase = scene::MetaballPhase::kRayleigh;
    for (scene::Scene* each : {&s, &dark, &other}) each->metaballsAs = as;
    EXPECT_NO_THROW(scene::validate(s));
    for (const scene::Scene* each : {&dark, &other}) {
      if (marched)
        EXPECT_THROW(scene::validate(*each), ParameterError);
      else
        EXPECT_NO_THROW(scene::validate(*each));
    }
  }
  s.metaballs.assign(300, cloudAt(1000.0));
  EXPECT_THROW(scene::validate(s), ParameterError);
}

}  // namespace
}  // namespace welkin::render
