// SPDX-License-Identifier: Apache-2.0
// Presets and themes of sheets.
#include "welkin/scene/theme.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "welkin/core/error.h"
#include "welkin/scene/scene_file.h"

namespace welkin::scene {
namespace {

class ThemeTest : public ::testing::Test {
 protected:
  ThemeTest() { std::filesystem::create_directories(folder_); }
  ~ThemeTest() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  template <class E>
  static std::string problemOf(const std::string& theme) {
    try {
      readTheme(theme);
    } catch (const E& e) {
      return e.what();
    }
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("welkin_theme_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(ThemeTest, BuiltInOnesComeBackFromTheirFiles) {
  for (const std::string_view name : kThemeNames) {
    const Theme theme = readTheme(std::string(name));
    EXPECT_FALSE(theme.sheets.empty()) << name;
    for (const Sheet& sheet : theme.sheets) EXPECT_NO_THROW(validate(sheet));
    const std::string file = write("t.toml", themeToToml(theme));
    EXPECT_EQ(readTheme(file), theme) << name;
    // It is a scene file as well.
    EXPECT_EQ(themeOf(readSceneFile(file).scene), theme) << name;
    EXPECT_NO_THROW(validate(readSceneFile(file).scene));
  }
}

TEST_F(ThemeTest, TheThesissLayersAreOne) {
  const Theme theme = readTheme("thesis-combined");
  ASSERT_EQ(theme.sheets.size(), 3u);
  EXPECT_EQ(theme.technique, Technique::kPlane);
  EXPECT_EQ(theme.sheets[0].heightM, 1400.0);
  EXPECT_EQ(theme.sheets[1].heightM, 1200.0);
  EXPECT_EQ(theme.sheets[2].heightM, 900.0);
  for (const Sheet& sheet : theme.sheets) EXPECT_EQ(sheet.surface, SheetSurface::kPlane);
}

TEST_F(ThemeTest, ASceneGoesOverItsTheme) {
  const std::string file =
      write("mine.toml", "technique = \"dome\"\n[drift]\nwind_deg = 10\n[[sheet]]\noktas = 3\n");
  const std::string scene = write(
      "s.toml", "theme = \"mine.toml\"\ntier = \"flat\"\n[drift]\nperiod_h = 7\n[[sheet]]\noktas = 5\n");
  const Scene s = readSceneFile(scene).scene;
  EXPECT_EQ(s.technique, Technique::kDome);
  EXPECT_EQ(s.tier, SheetTier::kFlat);
  EXPECT_EQ(s.drift.windDeg, 10.0);
  EXPECT_EQ(s.drift.periodH, 7.0);
  ASSERT_EQ(s.sheets.size(), 2u);
  EXPECT_EQ(s.sheets[0].oktas, 3.0);
  EXPECT_EQ(s.sheets[1].oktas, 5.0);
  EXPECT_FALSE(s.theme);
  // What it comes to reads back as the same, and another theme wins over the file's.
  EXPECT_EQ(parseScene(sceneToToml(s), "again.toml").scene, s);
  EXPECT_EQ(readSceneFile(scene, {}, "thesis-few").scene.sheets[0].heightM, 900.0);
}

TEST_F(ThemeTest, MistakesNameTheNearest) {
  EXPECT_NE(problemOf<ParameterError>("thesis-overcats").find("did you mean \"thesis-overcast\"?"),
            std::string::npos);
  EXPECT_NE(problemOf<ParameterError>("zzzzzzzzz").find("expected one of thesis-overcast"),
            std::string::npos);
  EXPECT_NE(problemOf<IoError>((folder_ / "none.toml").string()).find("none.toml"), std::string::npos);
  const std::string typo = write("typo.toml", "[[sheet]]\ncutof = 0.5\n");
  EXPECT_EQ(problemOf<ParseError>(typo),
            typo + ":2:1: unknown key \"cutof\" in [[sheet]]; did you mean \"cutoff\"?");
  EXPECT_NE(
      problemOf<ParseError>(write("place.toml", "[place]\nlatitude_deg = 3\n")).find("unknown key \"place\""),
      std::string::npos);
  try {
    readSceneFile(write("s.toml", "seed = 3\ntheme = \"thesis-dom\"\n"));
    ADD_FAILURE();
  } catch (const ParseError& e) {
    EXPECT_EQ(e.line(), 2);
  }
}

TEST_F(ThemeTest, PresetsAreWhatTheOtherKeysGoOver) {
  const Scene s = parseScene(
                      "technique = \"plane\"\n[[sheet]]\npreset = \"thesis-broken\"\nheight_m = 2000\n"
                      "[[sheet]]\npreset = \"thesis-overcast\"\nexponent = 1e-4\n",
                      "s.toml")
                      .scene;
  Sheet expected = sheetOf(field::ThesisTexture::kBroken);
  expected.heightM = 2000.0;
  EXPECT_EQ(s.sheets[0], expected);
  EXPECT_FALSE(s.sheets[1].density);
  EXPECT_EQ(s.sheets[1].exponent, 1e-4);
  EXPECT_NO_THROW(validate(s));
  EXPECT_EQ(parseScene(sceneToToml(s), "again.toml").scene, s);
  try {
    parseScene("[[sheet]]\npreset = \"thesis-brocken\"\n", "s.toml");
    ADD_FAILURE();
  } catch (const ParseError& e) {
    EXPECT_EQ(e.line(), 2);
    EXPECT_NE(std::string(e.what()).find("thesis-broken"), std::string::npos);
  }
}

// The thesis's shader and its textures: 1 - exponent^x = 1 - density^(255 x).
TEST_F(ThemeTest, ExponentAndDensityAreTheSameLaw) {
  const float pattern[] = {0.0f, 1.0f};
  Sheet byDensity, byExponent;
  byDensity.density = 0.97;
  byExponent.exponent = std::pow(0.97, 255.0);
  byDensity.bias = byExponent.bias = 0.8;
  EXPECT_NEAR(condensationOf(byExponent, pattern).opacity(0.63),
              condensationOf(byDensity, pattern).opacity(0.63), 1e-9);
  byDensity.exponent = 0.5;
  EXPECT_THROW(validate(byDensity), ParameterError);
}

}  // namespace
}  // namespace welkin::scene
