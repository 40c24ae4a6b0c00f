// SPDX-License-Identifier: Apache-2.0
// The shadows of thin layers on the ground, seen from beneath them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"
#include "welkin/shading/sheet_look.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

constexpr int kSide = 96;

class SheetShadowTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  // Straight down at a ground of one material but for its fields.
  static scene::Scene downwards(double eyeM) {
    scene::Scene s = looking(sized(clearScene(50.0), kSide, kSide), 0.0, -90.0, 90.0);
    s.technique = scene::Technique::kSkyPlane;
    s.camera.eyeM = eyeM;
    return s;
  }
  Image<float> drawn(const scene::Scene& scene) {
    sky.update(scene, 0.0);
    sky.draw(shading::viewOf(sky.state()), target);
    return target.readPicture(0, 3);
  }
  // On the ground, by sky and by the key light where no cloud is before it.
  glm::vec3 skyLux() const { return sky.state().ambient.skyOnGround; }
  glm::vec3 directLux() const {
    const sky::Light& key = sky.state().lights[0];
    return key.illuminance * key.direction.z *
           sky.state().atmosphere->transmittanceToSpace(0.0, key.direction.z);
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{kSide, kSide, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
  LiveSky sky;
};

// Half of the sun's light passes; what the ground shows is that and the sky's as the ambient says.
TEST_F(SheetShadowTest, AnEvenSheetDimsDirectLightByWhatItHides) {
  scene::Scene s = downwards(20.0);  // with next to no air between
  const double before = luminanceOf(meanOf(drawn(s)));
  const double clear = luminanceOf(skyLux() + directLux());
  scene::Sheet sheet;
  sheet.texels = 64;
  sheet.octaves = 1;
  sheet.cutoff = 0.0;
  sheet.density = 0.01;
  sheet.bias = 0.5;
  for (const auto surface :
       {scene::SheetSurface::kSkyPlane, scene::SheetSurface::kDome, scene::SheetSurface::kHemisphere}) {
    sheet.surface = surface;  // that of what comes down to the ground is the mean
    s.sheets = {sheet};
    const double after = luminanceOf(meanOf(drawn(s)));
    const double expected = luminanceOf(skyLux() + 0.5f * directLux());
    EXPECT_NEAR(after / before, expected / clear, 0.01);
  }
}

// Each point is lit or not as the pattern says where the line from it to the sun meets the sheet.
TEST_F(SheetShadowTest, ShadowsLieWhereThePatternIsBeforeTheSun) {
  scene::Scene s = downwards(1000.0);
  scene::Sheet sheet;
  sheet.heightM = 1400.0;
  sheet.tileM = 4000.0;
  sheet.texels = 256;
  sheet.octaves = 2;
  sheet.cutoff = 0.5;
  sheet.density = 0.01;  // cloud or none
  s.sheets = {sheet};
  const Image<float> got = drawn(s);
  const std::uint64_t seed = scene::sheetSeed(s, 0);
  const Image<float> pattern = scene::flatPattern(sheet, seed);
  const glm::vec3 key = sky.state().lights[0].direction;
  const shading::SheetLook look = shading::lookOf(sheet, shading::matterOf(sheet, pattern.data, seed), 0.0,
                                                  glm::dvec3(0.0, 0.0, 1000.0), key, 0.01f);
  const double lit = luminanceOf(skyLux() + directLux()), dark = luminanceOf(skyLux());
  const double threshold = luminanceOf(meanOf(got));
  int agree = 0, shaded = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      // The heading, north, is at the top.
      const glm::vec3 ground(1000.0f * ((static_cast<float>(x) + 0.5f) / (0.5f * kSide) - 1.0f),
                             1000.0f * (1.0f - (static_cast<float>(y) + 0.5f) / (0.5f * kSide)), 0.0f);
      const glm::vec3 at = look.offset + (ground + key * (look.heightM / key.z)) * look.perM;
      const auto texel = [](float u) { return static_cast<int>(std::floor((u - std::floor(u)) * 256.0f)); };
      const bool cloud = pattern.at(texel(at.x), texel(at.y)) > look.threshold;
      shaded += cloud;
      agree += cloud == (luminanceOf(pixel(got, x, y)) < threshold);
    }
  EXPECT_GT(shaded, kSide * kSide / 5);
  EXPECT_LT(shaded, kSide * kSide * 4 / 5);
  EXPECT_GT(agree, kSide * kSide * 97 / 100);
  EXPECT_LT(dark, 0.6 * lit);
}

// Seen from the ground, which the lower of them hides the upper from.
TEST_F(SheetShadowTest, ASheetIsDimUnderAnother) {
  scene::Scene s = looking(sized(clearScene(50.0), kSide, kSide), 0.0, 60.0);
  s.technique = scene::Technique::kSkyPlane;
  scene::Sheet low;
  low.heightM = 1000.0;
  low.texels = 64;
  low.cutoff = 0.0;
  low.density = 0.8;
  scene::Sheet high = low;
  high.heightM = 5000.0;
  for (const auto tier : {scene::SheetTier::kFlat, scene::SheetTier::kEmbossed, scene::SheetTier::kLit}) {
    low.tier = tier;
    s.sheets = {low};
    const double alone = luminanceOf(meanOf(drawn(s)));
    s.sheets = {low, high};
    EXPECT_LT(luminanceOf(meanOf(drawn(s))), 0.5 * alone);
  }
}

}  // namespace
}  // namespace welkin::render
