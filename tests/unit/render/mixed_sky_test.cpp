// SPDX-License-Identifier: Apache-2.0
// Thin layers among marched volumes in stills.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/shading/sheet_look.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using scene::SheetSurface;
using scene::SheetTier;
using weather::Genus;

// Hides `bias` of everything everywhere, to the last bit: its pattern is above the cutoff by far.
scene::Sheet evenSheet(double heightM, double bias, SheetSurface surface = SheetSurface::kSkyPlane) {
  scene::Sheet sheet;
  sheet.surface = surface;
  sheet.heightM = heightM;
  sheet.texels = 32;
  sheet.octaves = 1;
  sheet.cutoff = 0.0;
  sheet.density = 0.01;
  sheet.bias = bias;
  return sheet;
}

// Islands of cloud in every other place.
scene::Sheet islands(double heightM, SheetSurface surface = SheetSurface::kSkyPlane) {
  scene::Sheet sheet;
  sheet.surface = surface;
  sheet.heightM = heightM;
  sheet.tileM = surface == SheetSurface::kDome ? 3000.0 : 8000.0;
  sheet.texels = surface == SheetSurface::kDome ? 64 : 256;
  sheet.octaves = 4;
  sheet.oktas = 4.0;
  return sheet;
}

class MixedSkyTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : renderer.takeErrors()) ADD_FAILURE() << error;
  }
  Image<float> drawn(const scene::Scene& s) { return renderer.draw(scene::buildSky(s, 0.0)).luminance; }

  // Of the sun's disc, which outshines all cloud before it: what arrives of it from an eye.
  double sunAt(scene::Scene s, double eyeM) {
    s = sized(fromHeight(std::move(s), eyeM), 8, 8);
    const scene::SkyLights lights = scene::lightsAt(s, 0.0);
    const sky::Body& sun = lights.ephemeris.sun;
    s = looking(s, sun.azimuthDeg, sun.elevationDeg, 0.2);
    return luminanceOf(meanOf(drawn(s)));
  }

  SkyRenderer renderer{{.debug = true}};
};

// Whichever pattern the sheet has, an opaque deck hides it from beneath, as it hides the deck from above.
TEST_F(MixedSkyTest, WhatIsNearerHidesWhatIsFarther) {
  scene::Scene s = cloudyScene(50.0, {Genus::kNimbostratus}, 8.0);
  s.sheets = {islands(12000.0)};
  scene::Scene other = s;
  other.sheets[0].tileM = 10500.0;  // the same matter, elsewhere
  const auto changes = [&](double eyeM, double pitchDeg) {
    return relativeDifference(drawn(fromHeight(looking(s, 0.0, pitchDeg), eyeM)),
                              drawn(fromHeight(looking(other, 0.0, pitchDeg), eyeM)));
  };
  const double hidden = changes(2.0, 40.0);  // beneath the deck
  EXPECT_LT(hidden, 0.005);
  EXPECT_GT(changes(11000.0, 40.0), 0.08);   // between them
  EXPECT_GT(changes(18000.0, -40.0), 0.08);  // above both
  // Under a deck (a thin one, since under a thick one all is equally grey) it is the sheet that is seen.
  s.layers = other.layers = cloudyScene(50.0, {Genus::kCirrostratus}, 8.0).layers;
  s.sheets[0].heightM = other.sheets[0].heightM = 1500.0;
  s.sheets[0].tileM = 3000.0, other.sheets[0].tileM = 4000.0;
  EXPECT_GT(changes(2.0, 40.0), std::max(0.02, 5.0 * hidden));
}

// Through a volume and a sheet arrives the product of what each lets through, whichever is above.
TEST_F(MixedSkyTest, TransmittancesMultiply) {
  scene::Scene s = cloudyScene(40.0, {Genus::kCirrostratus}, 8.0);
  s.output.quality = scene::Quality::kMedium;
  scene::Scene clear = s;
  clear.layers.clear();
  const double none = sunAt(clear, 2.0), volume = sunAt(s, 2.0);
  EXPECT_LT(volume, 0.9 * none);
  EXPECT_GT(volume, 0.05 * none);
  const weather::Layer& layer = s.layers[0];
  for (const double heightM : {layer.baseM - 500.0, layer.topM + 500.0}) {
    s.sheets = clear.sheets = {evenSheet(heightM, 0.4)};
    EXPECT_NEAR(sunAt(clear, 2.0) / none, 0.6, 3e-3);
    EXPECT_NEAR(sunAt(s, 2.0) / volume, 0.6, 3e-3) << heightM;
  }
  // Through the middle, which the march steps into anew.
  s.sheets = {evenSheet(0.5 * (layer.baseM + layer.topM), 0.4)};
  EXPECT_NEAR(sunAt(s, 2.0) / volume, 0.6, 0.05);
  // From above both, neither.
  EXPECT_NEAR(sunAt(s, layer.topM + 1000.0) / sunAt(clear, layer.topM + 1000.0), 1.0, 4e-3);
}

// The sun stands below the horizon of an eye above the sheet, and above that of the ground: its light goes
// down through the sheet and up again.
TEST_F(MixedSkyTest, GrazingRaysMeetASheetTwice) {
  scene::Scene s = fromHeight(clearScene(-1.5), 12000.0);
  const double none = sunAt(s, 12000.0);
  ASSERT_GT(none, 1e4);
  s.sheets = {evenSheet(11500.0, 0.5)};
  EXPECT_NEAR(sunAt(s, 12000.0) / none, 0.25, 2e-3);
}

// Nothing is lost or found by going through the march with sheets: one that hides nothing changes nothing.
TEST_F(MixedSkyTest, ASheetOfNothingChangesNothing) {
  scene::Scene s = cloudyScene(30.0, {Genus::kCumulus, Genus::kAltostratus});
  const Image<float> without = drawn(s);
  s.sheets = {evenSheet(3000.0, 0.0)};
  EXPECT_LT(relativeDifference(without, drawn(s)), 2e-3);
}

// What was drawn before leaves no trace, to the last bit.
TEST_F(MixedSkyTest, SheetsComeAndGo) {
  const scene::Scene without = cloudyScene(30.0, {Genus::kStratus});
  scene::Scene with = without;
  with.sheets = {islands(4000.0)};
  const Image<float> first = drawn(without), sheets = drawn(with);
  EXPECT_NE(first.data, sheets.data);
  EXPECT_EQ(drawn(without).data, first.data);
  EXPECT_EQ(drawn(with).data, sheets.data);
}

// The meshes of the frame loop and the rays of the still are two ways to one picture.
TEST_F(MixedSkyTest, ASheetAloneIsThatOfTheFrameLoop) {
  for (const double sunElevationDeg : {35.0, 2.0}) {
    scene::Scene s = looking(sized(clearScene(sunElevationDeg), 96, 54), 200.0, 30.0);
    s.technique = scene::Technique::kSkyPlane;
    for (const auto surface :
         {SheetSurface::kPlane, SheetSurface::kSkyPlane, SheetSurface::kDome, SheetSurface::kHemisphere})
      for (const auto tier : {SheetTier::kFlat, SheetTier::kEmbossed, SheetTier::kLit}) {
        s.sheets = {islands(2000.0, surface)};
        s.sheets[0].tier = tier;
        const Image<float> still = drawn(s);
        gpu::Context context({.debug = true});
        const gpu::Texture2D texture(96, 54, {.format = gpu::Format::kRgba32F});
        const gpu::Framebuffer target(texture);
        LiveSky sky;
        sky.update(s, 0.0);
        Image<float> live(96, 54, 3);
        // The still's sub-frames blur over a pixel; so does the mean of a few here.
        for (const glm::dvec2 shift : {glm::dvec2(-0.25, -0.25), glm::dvec2(0.25, -0.25),
                                       glm::dvec2(-0.25, 0.25), glm::dvec2(0.25, 0.25)}) {
          sky.draw(shading::viewOf(sky.state(), shift), target);
          const Image<float> one = target.readPicture(0, 3);
          for (std::size_t i = 0; i < live.data.size(); ++i) live.data[i] += 0.25f * one.data[i];
        }
        SCOPED_TRACE("sun at " + std::to_string(sunElevationDeg) + ", surface " +
                     std::to_string(static_cast<int>(surface)) + ", tier " +
                     std::to_string(static_cast<int>(tier)));
        EXPECT_LT(relativeDifference(still, live), 0.03);
        // The plane's mesh has few vertices, where the peak of forward scattering is taken.
        EXPECT_NEAR(luminanceOf(meanOf(still)) / luminanceOf(meanOf(live)), 1.0,
                    surface == SheetSurface::kPlane ? 0.04 : 0.01);
        const double contrast = relativeDifference(still, [&] {
          Image<float> mean(96, 54, 3);
          const glm::vec3 m = meanOf(still);
          for (std::size_t i = 0; i < mean.data.size(); ++i) mean.data[i] = m[static_cast<int>(i % 3)];
          return mean;
        }());
        EXPECT_GT(contrast, 0.1);  // there is something to agree on
      }
  }
}

// Straight up, where columns of the picture are lines of the pattern: no line stands out where it begins
// anew.
TEST_F(MixedSkyTest, HasNoSeamWhereThePatternRepeats) {
  scene::Scene s = sized(clearScene(60.0), 160, 40);
  s = looking(s, 0.0, 90.0, 90.0);
  for (const auto surface : {SheetSurface::kPlane, SheetSurface::kDome}) {
    s.sheets = {islands(2000.0, surface)};
    s.sheets[0].tileM = 2500.0;
    s.sheets[0].frequency = 4;
    s.sheets[0].texels = 64;
    const Image<float> got = drawn(s);
    const std::uint64_t seed = scene::sheetSeed(s, 0);
    const std::vector<float> pattern = surface == SheetSurface::kDome
                                           ? scene::domePattern(s.sheets[0], seed).data
                                           : scene::flatPattern(s.sheets[0], seed).data;
    const shading::SheetMatter matter = shading::matterOf(s.sheets[0], pattern, seed);
    const shading::SheetLook look =
        shading::lookOf(s.sheets[0], matter, 0.0, glm::dvec3(0.0), {0, 0, 1}, 1.0f);
    double atSeam = 0.0, elsewhere = 0.0;
    int seams = 0, others = 0;
    for (int y = 8; y < 32; ++y) {
      const auto tile = [&](int x) {
        // Up is south at heading 0: east is on the right still.
        const double u = ((x + 0.5) / 80.0 - 1.0), v = (y + 0.5 - 20.0) / 80.0;
        // On the dome, ten times as wide as high, from the ground.
        const double t = surface == SheetSurface::kDome ? 1.0 / std::sqrt(1.0 + 0.01 * (u * u + v * v)) : 1.0;
        return std::floor(look.offset.x + 2000.0 * u * t / 2500.0);
      };
      for (int x = 1; x + 2 < 160; ++x) {
        // How far the step is from those beside it.
        const auto l = [&](int at) { return luminanceOf(pixel(got, at, y)); };
        const double jump = std::abs(l(x + 1) - l(x) - 0.5 * (l(x) - l(x - 1)) - 0.5 * (l(x + 2) - l(x + 1)));
        (tile(x) != tile(x + 1) ? atSeam : elsewhere) += jump;
        ++(tile(x) != tile(x + 1) ? seams : others);
      }
    }
    ASSERT_GE(seams, 24);
    EXPECT_LT(atSeam / seams, 2.0 * elsewhere / others);
  }
}

// All around on the horizon of a dome: the picture's two ends meet as any two columns do.
TEST_F(MixedSkyTest, DomesHaveNoMeridian) {
  scene::Scene s = projected(clearScene(60.0), scene::Projection::kEquirect, 128, 64);
  s.sheets = {islands(2000.0, SheetSurface::kDome)};
  const Image<float> got = drawn(s);
  double seam = 0.0, within = 0.0;
  for (int y = 8; y < 30; ++y) {
    const auto l = [&](int x) { return luminanceOf(pixel(got, x & 127, y)); };
    seam += std::abs(l(128) - l(127)) / 22.0;
    for (int x = 0; x < 127; ++x) within += std::abs(l(x + 1) - l(x)) / (22.0 * 127.0);
  }
  EXPECT_GT(within, 0.0);
  EXPECT_LT(seam, 2.5 * within);
}

// What volumes leave of the sunlight on the ground, a sheet above them takes its share of.
TEST_F(MixedSkyTest, ShadowsOnTheGroundMultiply) {
  scene::Scene s = cloudyScene(50.0, {Genus::kCumulus});
  s = fromHeight(looking(sized(s, 48, 48), 0.0, -90.0, 120.0), 900.0);
  s.output.quality = scene::Quality::kMedium;
  const Image<float> without = drawn(s);
  s.sheets = {evenSheet(9000.0, 0.5)};
  const Image<float> with = drawn(s);
  // Sky and direct light add up: over the picture's light and dark places the one is a straight line of the
  // other, half as steep.
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const double a = luminanceOf(pixel(without, x, y)), b = luminanceOf(pixel(with, x, y));
      n += 1.0, sx += a, sy += b, sxx += a * a, sxy += a * b;
    }
  const double variance = sxx / n - sx * sx / (n * n);
  EXPECT_GT(std::sqrt(variance), 0.2 * sx / n);  // there are shadows
  EXPECT_NEAR((sxy / n - sx * sy / (n * n)) / variance, 0.5, 0.06);
}

// Each shades what is beneath it.
TEST_F(MixedSkyTest, SheetsAndVolumesShadeEachOther) {
  // Above the sheet, which is between the eye and nothing: volumes seen from above with a sheet over them.
  scene::Scene deck = fromHeight(looking(cloudyScene(50.0, {Genus::kStratus}, 8.0), 0.0, -60.0), 3000.0);
  const double alone = luminanceOf(meanOf(drawn(deck)));
  deck.sheets = {evenSheet(8000.0, 0.6)};
  const double beneath = luminanceOf(meanOf(drawn(deck)));
  EXPECT_LT(beneath, 0.75 * alone);
  EXPECT_GT(beneath, 0.3 * alone);

  scene::Scene under = looking(clearScene(50.0), 0.0, 60.0);
  under.sheets = {islands(400.0)};
  under.sheets[0].oktas = 8.0;
  const double sunny = luminanceOf(meanOf(drawn(under)));
  under.layers = cloudyScene(50.0, {Genus::kNimbostratus}, 8.0).layers;
  EXPECT_LT(luminanceOf(meanOf(drawn(under))), 0.4 * sunny);
}

// Volumes before the sun take their share of the flare.
TEST_F(MixedSkyTest, FlaresPassVolumesAsTheSunDoes) {
  const auto flareOf = [&](scene::Scene s) {
    const scene::SkyLights lights = scene::lightsAt(s, 0.0);
    s = looking(sized(s, 48, 48), lights.ephemeris.sun.azimuthDeg, lights.ephemeris.sun.elevationDeg - 20.0,
                70.0);
    const Image<float> without = drawn(s);
    s.output.flare = 0.05;
    const Image<float> with = drawn(s);
    return luminanceOf(meanOf(with)) - luminanceOf(meanOf(without));
  };
  scene::Scene s = clearScene(40.0);
  const double clear = flareOf(s);
  EXPECT_GT(clear, 0.0);
  s.layers = cloudyScene(40.0, {Genus::kCirrostratus}, 8.0).layers;
  s.output.quality = scene::Quality::kMedium;
  scene::Scene none = s;
  none.layers.clear();
  const double share = sunAt(s, 2.0) / sunAt(none, 2.0);
  EXPECT_NEAR(flareOf(s) / clear, share, 0.05);
  s.layers = cloudyScene(40.0, {Genus::kNimbostratus}, 8.0).layers;
  EXPECT_LT(flareOf(s), 1e-3 * clear);
}

}  // namespace
}  // namespace welkin::render
