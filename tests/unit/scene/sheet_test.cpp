// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "welkin/core/error.h"
#include "welkin/scene/scene.h"
#include "welkin/scene/scene_file.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

TEST(Sheet, CoverIsDelivered) {
  for (const double oktas : {0.0, 1.0, 3.0, 5.0, 7.5, 8.0})
    for (const std::uint64_t seed : {1ull, 99ull}) {
      Sheet sheet;
      sheet.texels = 128;
      sheet.oktas = oktas;
      // Counted here by opacity, texel by texel.
      const Image<float> pattern = flatPattern(sheet, seed);
      const field::Condensation law = condensationOf(sheet, pattern.data);
      double count = 0.0;
      for (const float p : pattern.data) count += law.opacity(p) >= 0.2591;  // 1 - exp(-0.3), a little less
      const double cover = count / static_cast<double>(pattern.data.size());
      EXPECT_NEAR(cover, oktas / 8.0, 0.001) << oktas;
      EXPECT_NEAR(deliveredCover(sheet, seed), cover, 0.001) << oktas;
    }
}

TEST(Sheet, PatternTilesAndGoesByItsSeed) {
  Sheet sheet;
  sheet.texels = 256;
  const Image<float> a = flatPattern(sheet, 1), b = flatPattern(sheet, 1 << 20);
  EXPECT_NE(a.data, b.data);
  double seam = 0.0, within = 0.0;
  for (int y = 0; y < 256; ++y) {
    seam += std::abs(a.at(255, y) - a.at(0, y)) / 256.0;
    for (int x = 0; x < 255; ++x) within += std::abs(a.at(x + 1, y) - a.at(x, y)) / (256.0 * 255.0);
  }
  EXPECT_NEAR(seam / within, 1.0, 0.25);
}

TEST(Sheet, ThesisPresetsHaveItsNumbers) {
  const Sheet few = sheetOf(field::ThesisTexture::kFew);
  EXPECT_EQ(few.octaves, 8);
  EXPECT_EQ(few.frequency, 16);
  EXPECT_EQ(few.cutoff, 0.8);
  EXPECT_EQ(few.heightM, 900.0);
  EXPECT_EQ(sheetOf(field::ThesisTexture::kDome).surface, SheetSurface::kDome);
}

TEST(Sheet, WeatherBecomesSheets) {
  Scene s;
  s.layers = {weather::typicalLayer(weather::Genus::kStratocumulus, 47.0),
              weather::typicalLayer(weather::Genus::kCirrus, 47.0)};
  weather::Weather w;
  w.layers = s.layers;
  EXPECT_TRUE(sheetsOf(s, w).empty());  // volumes
  s.technique = Technique::kSkyPlane;
  s.sheets.emplace_back();
  const auto sheets = sheetsOf(s, w);
  ASSERT_EQ(sheets.size(), 3u);
  EXPECT_GT(sheets[0].heightM, s.layers[0].baseM);
  EXPECT_LT(sheets[0].heightM, s.layers[0].topM);
  EXPECT_EQ(sheets[1].oktas, s.layers[1].oktas);
  EXPECT_LT(sheets[0].density, sheets[1].density);  // cirrus is thinner
}

// A layer's own technique wins over the scene's; sheets by hand stand beside volumes.
TEST(Sheet, LayersChooseTheirTechnique) {
  Scene s = parseScene(
                "[[layer]]\ngenus = \"cumulus\"\n[[layer]]\ngenus = \"cirrus\"\ntechnique = \"plane\"\n"
                "[[sheet]]\nheight_m = 500\n",
                "t.toml")
                .scene;
  EXPECT_EQ(parseScene(sceneToToml(s), "again.toml").scene, s);
  EXPECT_NO_THROW(validate(s));
  const weather::Weather w = weatherOf(s);
  auto sheets = sheetsOf(s, w);
  ASSERT_EQ(sheets.size(), 2u);
  EXPECT_EQ(sheets[0].surface, SheetSurface::kPlane);
  EXPECT_EQ(sheets[1].heightM, 500.0);
  s.technique = Technique::kDome;
  s.layers[1].technique = Technique::kVolume;
  sheets = sheetsOf(s, weatherOf(s));
  ASSERT_EQ(sheets.size(), 2u);
  EXPECT_EQ(sheets[0].surface, SheetSurface::kDome);
  EXPECT_LT(sheets[0].heightM, 3000.0);
}

// Each as its pattern has it, and all together by random overlap with the volumes.
TEST(Sheet, CountsInTheDeliveredCover) {
  Scene s;
  s.layers = {weather::typicalLayer(weather::Genus::kStratocumulus, 47.0),
              weather::typicalLayer(weather::Genus::kCirrus, 47.0)};
  s.layers[0].oktas = s.layers[1].oktas = 4.0;
  s.layers[1].technique = Technique::kSkyPlane;
  Sheet sheet;
  sheet.texels = 128;
  sheet.oktas = 2.0;
  s.sheets = {sheet, sheet};
  s.sheets[1].oktas.reset();
  const SkyState state = buildSky(s, 0.0);
  ASSERT_EQ(state.cover.size(), 2u);
  ASSERT_EQ(state.sheetCover.size(), 2u);
  EXPECT_NEAR(state.cover[0].deliveredOktas, 4.0, 0.5);
  EXPECT_NEAR(state.cover[1].deliveredOktas, 4.0, 0.01);
  EXPECT_EQ(state.sheetCover[0].requestedOktas, 2.0);
  EXPECT_NEAR(state.sheetCover[0].deliveredOktas, 2.0, 0.01);
  // Nobody asked for so many oktas of it.
  EXPECT_EQ(state.sheetCover[1].requestedOktas, state.sheetCover[1].deliveredOktas);
  double clear = 1.0;
  for (const auto* covers : {&state.cover, &state.sheetCover})
    for (const LayerCover& c : *covers) clear *= 1.0 - c.deliveredOktas / 8.0;
  EXPECT_NEAR(state.skyCover.deliveredOktas, 8.0 * (1.0 - clear), 1e-9);
  EXPECT_NEAR(state.skyCover.requestedOktas, state.skyCover.deliveredOktas, 0.5);
  // A sequence carries it.
  EXPECT_EQ(buildSky(s, 60.0, &state).sheetCover.size(), 2u);
}

TEST(Sheet, FlaresAreForLenses) {
  Scene s;
  s.output.flare = 0.01;
  EXPECT_NO_THROW(validate(s));  // beside volumes, too
  s.camera.projection = Projection::kFisheye;
  EXPECT_THROW(validate(s), ParameterError);
}

TEST(Sheet, IsReadFromSceneFiles) {
  const Scene s =
      parseScene("technique = \"plane\"\n[[sheet]]\ntier = \"embossed\"\nheight_m = 900\noktas = 2\n",
                 "t.toml")
          .scene;
  ASSERT_EQ(s.sheets.size(), 1u);
  EXPECT_EQ(s.technique, Technique::kPlane);
  EXPECT_EQ(s.sheets[0].tier, SheetTier::kEmbossed);
  EXPECT_EQ(s.sheets[0].oktas, 2.0);
  EXPECT_EQ(parseScene(sceneToToml(s), "again.toml").scene, s);
  EXPECT_THROW(parseScene("[[sheet]]\nheigth_m = 900\n", "t.toml"), ParseError);
  EXPECT_THROW(parseScene("[[sheet]]\nsurface = \"dome\"\ntexels = 512\n", "t.toml"), ParseError);
  for (const char* keys : {"", "preset = \"thesis-few\"\n", "texture = \"volume.dds\"\n"})
    EXPECT_EQ(
        parseScene("[[sheet]]\nsurface = \"dome\"\n" + std::string(keys), "t.toml").scene.sheets.at(0).texels,
        128);
  try {
    parseScene("[[sheet]]\nsurface = \"dome\"\npattern = \"octaves\"\n", "t.toml");
    ADD_FAILURE() << "living octaves on a dome";
  } catch (const ParseError& e) {
    EXPECT_NE(std::string(e.what()).find("a dome needs a volume of noise"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace welkin::scene
