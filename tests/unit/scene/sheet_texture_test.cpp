// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sheet_texture.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/testing/skies.h"
#include "welkin/io/texel_file.h"
#include "welkin/scene/scene_file.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

constexpr io::TexelFormat kL8{io::Channels::kL, io::ValueType::kUnorm8};

class SheetTextureTest : public ::testing::Test {
 protected:
  SheetTextureTest() { std::filesystem::create_directories(folder_); }
  ~SheetTextureTest() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // A ramp of greys, each value as often as every other.
  std::string writeRamp(const std::string& name) const {
    Image<std::uint8_t> ramp(64, 32, 1);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x) ramp.at(x, y) = static_cast<std::uint8_t>(8 * y + x / 8);
    io::writeTexels(path(name), io::toTexels(ramp, kL8));
    return path(name);
  }
  static Sheet sheetWith(const std::string& file) {
    Sheet sheet;
    sheet.texels = 32;
    sheet.texture = file;
    return sheet;
  }

  std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("welkin_sheet_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(SheetTextureTest, IsThePatternAsItStands) {
  for (const char* name : {"ramp.dds", "ramp.png", "ramp.raw"}) {
    const PatternTexels pattern = patternOf(sheetWith(writeRamp(name)), 5);
    EXPECT_TRUE(pattern.fromFile) << pattern.warning;
    EXPECT_EQ(pattern.flat.width, 64);
    EXPECT_EQ(pattern.flat.height, 32);
    EXPECT_FLOAT_EQ(pattern.flat.at(17, 3), 26.0f / 255.0f) << name;
  }
}

TEST_F(SheetTextureTest, CoverIsDelivered) {
  Sheet sheet = sheetWith(writeRamp("ramp.dds"));
  for (const double oktas : {0.0, 2.0, 5.0, 8.0}) {
    sheet.oktas = oktas;
    EXPECT_NEAR(8.0 * deliveredCover(sheet, 1), oktas, 8.0 / 256.0 + 1e-6);  // levels are that coarse
  }
  sheet.oktas.reset();
  sheet.cutoff = 0.5;
  sheet.density = 0.01;  // cloud as soon as above
  EXPECT_NEAR(deliveredCover(sheet, 1), 0.5, 2.0 / 256.0);
}

TEST_F(SheetTextureTest, OfSeveralChannelsItIsAlphaIfThatSaysAnything) {
  Image<std::uint8_t> rgba(16, 16, 4);
  for (int i = 0; i < 256; ++i) {
    std::uint8_t* texel = &rgba.data[static_cast<std::size_t>(4 * i)];
    texel[0] = 30, texel[1] = 60, texel[2] = 90, texel[3] = static_cast<std::uint8_t>(i);
  }
  constexpr io::TexelFormat kRgba8{io::Channels::kRgba, io::ValueType::kUnorm8};
  io::writeTexels(path("alpha.png"), io::toTexels(rgba, kRgba8));
  EXPECT_FLOAT_EQ(patternOf(sheetWith(path("alpha.png")), 1).flat.at(3, 2), 35.0f / 255.0f);
  for (std::size_t i = 3; i < rgba.data.size(); i += 4) rgba.data[i] = 255;
  io::writeTexels(path("opaque.png"), io::toTexels(rgba, kRgba8));
  EXPECT_FLOAT_EQ(patternOf(sheetWith(path("opaque.png")), 1).flat.at(3, 2), 60.0f / 255.0f);
}

TEST_F(SheetTextureTest, DomesTakeVolumes) {
  Volume<float> volume(8, 4, 2, 1);
  volume.at(7, 3, 1) = 0.75f;
  volume.at(0, 0, 0) = 3.0f;  // clamped
  io::writeTexels(path("v.dds"), io::toTexels(volume, {io::Channels::kR, io::ValueType::kFloat}));
  Sheet sheet = sheetWith(path("v.dds"));
  EXPECT_NE(patternOf(sheet, 1).warning.find("v.dds: a volume; expected a picture"), std::string::npos);
  sheet.surface = SheetSurface::kDome;
  const PatternTexels pattern = patternOf(sheet, 1);
  ASSERT_TRUE(pattern.fromFile) << pattern.warning;
  EXPECT_EQ(pattern.volume.at(7, 3, 1), 0.75f);
  EXPECT_EQ(pattern.volume.at(0, 0, 0), 1.0f);
  sheet.texture = writeRamp("ramp.dds");
  EXPECT_NE(patternOf(sheet, 1).warning.find("ramp.dds: a picture; expected a volume"), std::string::npos);
}

// A generated one stands in, the same as without a file.
TEST_F(SheetTextureTest, BrokenOnesAreWarnedOf) {
  std::ofstream(path("broken.dds")) << "DDS no more";
  for (const std::string& file : {path("none.dds"), path("broken.dds"), path("what.tiff")}) {
    const PatternTexels pattern = patternOf(sheetWith(file), 5);
    EXPECT_FALSE(pattern.fromFile);
    EXPECT_NE(pattern.warning.find(std::filesystem::path(file).filename().string()), std::string::npos)
        << pattern.warning;
    EXPECT_NE(pattern.warning.find("a generated texture stands in"), std::string::npos);
    Sheet generated = sheetWith(file);
    generated.texture.reset();
    EXPECT_EQ(pattern.flat.data, flatPattern(generated, 5).data);
    EXPECT_TRUE(patternOf(generated, 5).warning.empty());
  }
}

TEST_F(SheetTextureTest, StandsInTheSceneFileAndItsWarningsInTheSky) {
  writeRamp("ramp.dds");
  std::ofstream(path("s.toml")) << "technique = \"plane\"\n[[sheet]]\ntexture = \"ramp.dds\"\n"
                                   "[[sheet]]\ntexture = \"gone.dds\"\n";
  const Scene scene = readSceneFile(path("s.toml")).scene;
  EXPECT_EQ(scene.sheets[0].texture, path("ramp.dds"));
  const SkyState sky = buildSky(scene, 0.0);
  ASSERT_EQ(sky.warnings.size(), 1u);
  EXPECT_NE(sky.warnings[0].find("gone.dds"), std::string::npos);
  EXPECT_EQ(buildSky(scene, 1.0, &sky).warnings, sky.warnings);
}

}  // namespace
}  // namespace welkin::scene
