// SPDX-License-Identifier: Apache-2.0
// Sheets whose patterns come from files, and tinted ones, as they are drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/io/texel_file.h"
#include "welkin/render/live_sky.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

class SheetFileTest : public ::testing::Test {
 protected:
  ~SheetFileTest() override { std::filesystem::remove(file_); }
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }
  static scene::Scene upwards() {
    scene::Scene s = looking(sized(clearScene(50.0), 48, 48), 0.0, 90.0, 60.0);
    s.technique = scene::Technique::kSkyPlane;
    s.sheets.resize(1);
    s.sheets[0].texels = 64;
    s.sheets[0].heightM = 2000.0;
    s.sheets[0].tileM = 2000.0;
    return s;
  }
  Image<float> drawn(const scene::Scene& s, double seconds = 0.0) {
    sky.update(s, seconds);
    sky.draw(shading::viewOf(sky.state()), target);
    return target.readPicture(0, 3);
  }

  const std::string file_ = ::testing::TempDir() + "welkin_sheet_file_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".dds";
  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{48, 48, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
  LiveSky sky;
};

// The generated pattern, written and read back, draws the same sky.
TEST_F(SheetFileTest, AFileOfTheGeneratedPatternDrawsTheSame) {
  for (const auto surface : {scene::SheetSurface::kPlane, scene::SheetSurface::kDome}) {
    scene::Scene s = upwards();
    s.sheets[0].surface = surface;
    s.sheets[0].texels = 32;
    const Image<float> generated = drawn(s);
    const std::uint64_t seed = scene::sheetSeed(s, 0);
    constexpr io::TexelFormat kR32f{io::Channels::kR, io::ValueType::kFloat};
    if (surface == scene::SheetSurface::kDome)
      io::writeTexels(file_, io::toTexels(scene::domePattern(s.sheets[0], seed), kR32f));
    else
      io::writeTexels(file_, io::toTexels(scene::flatPattern(s.sheets[0], seed), kR32f));
    s.sheets[0].texture = file_;
    EXPECT_EQ(drawn(s).data, generated.data);
    EXPECT_TRUE(sky.state().warnings.empty());
    // The file's own number counts.
    s.sheets[0].texels = surface == scene::SheetSurface::kDome ? 256 : 512;
    EXPECT_EQ(drawn(s).data, generated.data);
  }
}

// Cloud over half of the file is cloud over half of the sky.
TEST_F(SheetFileTest, LoadedCoverIsSeen) {
  Image<std::uint8_t> halves(64, 64, 1);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) halves.at(x, y) = x < 32 ? 255 : 0;
  io::writeTexels(file_, io::toTexels(halves, {io::Channels::kL, io::ValueType::kUnorm8}));
  scene::Scene s = upwards();
  s.sheets[0].texture = file_;
  s.sheets[0].cutoff = 0.5;
  s.sheets[0].density = 0.01;
  s.sheets[0].tileM = 200.0;
  const Image<float> got = drawn(s);
  s.sheets.clear();
  const Image<float> clear = drawn(s);
  int cloudy = 0;
  for (std::size_t i = 2; i < got.data.size(); i += 3)
    cloudy += std::abs(got.data[i] / clear.data[i] - 1.0f) > 0.1f;
  EXPECT_NEAR(static_cast<double>(cloudy) / (48.0 * 48.0), 0.5, 0.08);
}

TEST_F(SheetFileTest, AMissingOneIsWarnedOfAndDrawnAsGenerated) {
  scene::Scene s = upwards();
  const Image<float> generated = drawn(s);
  s.sheets[0].texture = "none.dds";
  EXPECT_EQ(drawn(s).data, generated.data);
  ASSERT_EQ(sky.state().warnings.size(), 1u);
  EXPECT_NE(sky.state().warnings[0].find("none.dds"), std::string::npos);
}

// A black sheet hides as much as a white one; red light is left of a red one.
TEST_F(SheetFileTest, ColourTintsItsCloudInEveryTier) {
  for (const auto tier : {scene::SheetTier::kFlat, scene::SheetTier::kEmbossed, scene::SheetTier::kLit}) {
    scene::Scene s = upwards();
    s.sheets[0].tier = tier;
    s.sheets[0].cutoff = 0.0;
    s.sheets[0].density = 0.5;  // opaque all over
    const glm::vec3 white = meanOf(drawn(s));
    s.sheets[0].colour = {1.0, 0.5, 0.0};
    const glm::vec3 tinted = meanOf(drawn(s));
    EXPECT_NEAR(tinted.x / white.x, 1.0f, 1e-3f);
    EXPECT_NEAR(tinted.y / white.y, 0.5f, 0.06f);  // the air in front keeps its own
    EXPECT_LT(tinted.z / white.z, 0.15f);
  }
}

// Clouds come and go with the drift; a cut to any instant and back is the same frame.
TEST_F(SheetFileTest, DriftIsAPureFunctionOfTime) {
  scene::Scene s = upwards();
  s.sheets[0].oktas = 4.0;
  const Image<float> described = drawn(s);
  s.drift = {.windDeg = 60.0, .coverOktas = 4.0, .periodH = 1.0};
  EXPECT_EQ(drawn(s).data, described.data);
  const Image<float> later = drawn(s, 9000.0);
  drawn(s, 123456.0);
  EXPECT_EQ(drawn(s, 9000.0).data, later.data);
  EXPECT_EQ(drawn(s).data, described.data);
  LiveSky other;
  other.update(s, 9000.0);
  other.draw(shading::viewOf(other.state()), target);
  EXPECT_EQ(target.readPicture(0, 3).data, later.data);
}

}  // namespace
}  // namespace welkin::render
