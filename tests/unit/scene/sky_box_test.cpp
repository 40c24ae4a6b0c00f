// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sky_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "welkin/core/error.h"
#include "welkin/io/texel_file.h"
#include "welkin/scene/scene.h"
#include "welkin/scene/scene_file.h"

namespace welkin::scene {
namespace {

class SkyBoxTest : public ::testing::Test {
 protected:
  SkyBoxTest() { std::filesystem::create_directories(folder_); }
  ~SkyBoxTest() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Six faces of 4 pixels, each of one value, 10 times its number and 1 for each row.
  std::string writeStrip(const std::string& name) const {
    Image<float> strip(24, 4, 3);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 24; ++x)
        for (int c = 0; c < 3; ++c)
          strip.at(x, y, c) = 10.0f * static_cast<float>(x / 4) + static_cast<float>(y);
    io::writeTexels(path(name), io::toTexels(strip, {io::Channels::kRgb, io::ValueType::kFloat}));
    return path(name);
  }
  std::string writeGrey(const std::string& name, int width, int height, std::uint8_t grey) const {
    Image<std::uint8_t> image(width, height, 3);
    std::fill(image.data.begin(), image.data.end(), grey);
    io::writeTexels(path(name), io::toTexels(image, {io::Channels::kRgb, io::ValueType::kUnorm8}));
    return path(name);
  }
  static std::string problemOf(const SkyBox& box) {
    try {
      skyBoxFaces(box);
    } catch (const IoError& e) {
      return e.what();
    }
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("welkin_box_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(SkyBoxTest, AStripIsSixFacesInLuminance) {
  SkyBox box;
  EXPECT_TRUE(box.empty());
  box.strip = writeStrip("strip.exr");
  EXPECT_FALSE(box.empty());
  const auto faces = skyBoxFaces(box);
  for (int f = 0; f < 6; ++f) {
    const Image<float>& face = faces[static_cast<std::size_t>(f)];
    ASSERT_EQ(face.width, 4);
    ASSERT_EQ(face.height, 4);
    for (int y = 0; y < 4; ++y)
      EXPECT_EQ(face.at(2, y, 1), 10.0f * static_cast<float>(f) + static_cast<float>(y));
  }
}

TEST_F(SkyBoxTest, FilesOfIntegersAreSrgb) {
  SkyBox box;
  box.px = box.nx = box.py = box.ny = box.pz = writeGrey("white.png", 4, 4, 255);
  box.nz = writeGrey("grey.png", 4, 4, 188);  // half of the light
  box.whiteCdM2 = 2000.0;
  EXPECT_NO_THROW(validate(box));
  const auto faces = skyBoxFaces(box);
  EXPECT_FLOAT_EQ(faces[0].at(0, 0), 2000.0f);
  EXPECT_NEAR(faces[5].at(3, 3, 2), 1000.0f, 10.0f);
}

TEST_F(SkyBoxTest, WhatDoesNotFitIsNamed) {
  SkyBox box;
  box.strip = path("none.png");
  EXPECT_NE(problemOf(box).find("none.png"), std::string::npos);
  box.strip = path("none.tiff");
  EXPECT_NE(problemOf(box).find("none.tiff"), std::string::npos);
  box.strip = writeGrey("wide.png", 12, 4, 9);
  EXPECT_NE(problemOf(box).find("wide.png: 12x4 pixels; expected six square faces"), std::string::npos);
  box.strip.reset();
  box.px = box.nx = box.py = box.ny = box.pz = writeGrey("a.png", 4, 4, 9);
  EXPECT_THROW(validate(box), ParameterError);  // five
  box.nz = writeGrey("b.png", 8, 8, 9);
  EXPECT_NE(problemOf(box).find("b.png: 8x8 pixels"), std::string::npos);
  box.strip = path("x.png");
  EXPECT_THROW(validate(box), ParameterError);  // both

  Scene s;
  s.skyBox.strip = path("x.png");
  EXPECT_NO_THROW(validate(s));
}

TEST_F(SkyBoxTest, ItsPathsAreThoseOfTheSceneFile) {
  const Scene s = parseScene("[sky_box]\nstrip = \"b.exr\"\naxes = \"y_up\"\n", "some/where/s.toml").scene;
  EXPECT_EQ(s.skyBox.strip, "some/where/b.exr");
  EXPECT_EQ(s.skyBox.axes, BoxAxes::kYUp);
  EXPECT_EQ(parseScene("[sky_box]\nstrip = \"/b.png\"\n", "some/s.toml").scene.skyBox.strip, "/b.png");
  EXPECT_THROW(parseScene("[sky_box]\npx = \"b.png\"\n", "some/s.toml"), ParseError);  // one of six
}

}  // namespace
}  // namespace welkin::scene
