// SPDX-License-Identifier: Apache-2.0
// Cube maps, and filtering along the longer side of a pixel's footprint.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tests/testing/foreign_engine.h"
#include "welkin/core/error.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/state_guard.h"
#include "welkin/gpu/texture.h"

namespace welkin::gpu {
namespace {

class TextureTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }
  static Program fragmentProgram(const std::string& body) {
    return Program::graphics(
        {"#version 330 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == "
         "2 ? "
         "3.0 : -1.0, 0.0, 1.0); }\n",
         {"triangle.vert"}},
        {"#version 330 core\nlayout(location = 0) out vec4 oColour;\n" + body, {"test.frag"}});
  }
  Context context{{.debug = true}};
};

// Faces in OpenGL's order and orientation: by its specification's table, each face's first texel.
TEST_F(TextureTest, CubeFacesAreWhereOpenGlHasThem) {
  std::array<Image<float>, 6> faces;
  for (int f = 0; f < 6; ++f) {
    faces[static_cast<std::size_t>(f)] = Image<float>(8, 8, 3);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        faces[static_cast<std::size_t>(f)].at(x, y, 0) = static_cast<float>(f);
        faces[static_cast<std::size_t>(f)].at(x, y, 1) = static_cast<float>(x);
        faces[static_cast<std::size_t>(f)].at(x, y, 2) = static_cast<float>(y);
      }
  }
  const TextureCube cube(faces, {.format = Format::kRgba32F, .filter = Filter::kNearest});
  Program program = fragmentProgram(
      "uniform samplerCube uCube; uniform vec3 uDirection;\n"
      "void main() { oColour = texture(uCube, uDirection); }\n");
  const Texture2D texture(1, 1, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  const FullscreenTriangle triangle;
  // Towards the first texel of the first row of each face.
  constexpr float a = 0.9f;
  const std::array<glm::vec3, 6> first = {glm::vec3(1, a, a), {-1, a, -a}, {-a, 1, -a},
                                          {-a, -1, a},        {-a, a, 1},  {a, a, -1}};
  for (std::size_t f = 0; f < 6; ++f) {
    program.set("uDirection", first[f]);
    program.bind("uCube", cube);
    triangle.draw(program, target);
    const Image<float> got = target.readPicture();
    EXPECT_EQ(got.at(0, 0, 0), static_cast<float>(f));
    EXPECT_EQ(got.at(0, 0, 1), 0.0f) << f;
    EXPECT_EQ(got.at(0, 0, 2), 0.0f) << f;
  }
}

TEST_F(TextureTest, CubesAreFilteredAcrossTheirEdgesInsideAGuard) {
  std::array<Image<float>, 6> faces;
  for (auto& face : faces) face = Image<float>(2, 2, 1);
  std::fill(faces[0].data.begin(), faces[0].data.end(), 1.0f);
  const TextureCube cube(faces, {.format = Format::kR16F});
  Program program = fragmentProgram(
      "uniform samplerCube uCube;\nvoid main() { oColour = texture(uCube, vec3(1.0, 1.0, 0.0)); }\n");
  const Texture2D texture(1, 1, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  const FullscreenTriangle triangle;
  {
    const StateGuard guard;
    program.bind("uCube", cube);
    triangle.draw(program, target);
  }
  EXPECT_NEAR(target.readPicture().at(0, 0, 0), 0.5f, 0.05f);  // half of +x, half of +y
}

// Stripes that run away from the eye: without anisotropy a mipmap as coarse as the footprint is long blurs
// them away.
TEST_F(TextureTest, AnisotropyKeepsWhatLiesAslant) {
  Image<float> stripes(64, 64, 1);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) stripes.at(x, y) = x / 4 % 2 == 0 ? 1.0f : 0.0f;
  Program program = fragmentProgram(
      "uniform sampler2D uPattern;\n"
      "void main() { oColour = texture(uPattern, gl_FragCoord.xy * vec2(1.0, 8.0) / 64.0); }\n");
  const Texture2D texture(64, 64, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  const FullscreenTriangle triangle;
  const auto contrast = [&](float anisotropy) {
    Texture2D pattern(stripes, {.format = Format::kR16F,
                                .filter = Filter::kMipmap,
                                .wrapX = Wrap::kRepeat,
                                .wrapY = Wrap::kRepeat,
                                .anisotropy = anisotropy});
    program.bind("uPattern", pattern);
    triangle.draw(program, target);
    const Image<float> got = target.readPicture(0, 1);
    const auto [least, most] = std::minmax_element(got.data.begin(), got.data.end());
    return *most - *least;
  };
  EXPECT_LT(contrast(1.0f), 0.2f);
  if (!context.isSoftware() && contrast(8.0f) == contrast(1.0f)) GTEST_SKIP() << "the driver has none";
  EXPECT_GT(contrast(8.0f), 0.8f);
}

// Even where a texture cannot be made for its size.
TEST_F(TextureTest, AnEnginesErrorsAreLeftToIt) {
  testing::ForeignEngine::makeError();
  const Texture2D picture(4, 4, {.filter = Filter::kMipmap});
  const Texture3D volume(4, 4, 4, {});
  std::array<Image<float>, 6> faces;
  for (auto& face : faces) face = Image<float>(4, 4, 1);
  const TextureCube cube(faces, {.filter = Filter::kMipmap});
  EXPECT_THROW(Texture2D(1 << 24, 4), GpuError);
  EXPECT_TRUE(testing::ForeignEngine::hasError());
  EXPECT_FALSE(testing::ForeignEngine::hasError());
  context.takeErrors();  // the driver has recorded it as well
}

TEST_F(TextureTest, NoMemoryIsAnError) {
  if (!context.isSoftware()) GTEST_SKIP() << "others may have it";
  const int most = context.maxTextureSize3D();
  try {
    const Texture3D volume(most, most, most, {.format = Format::kRgba32F});
    FAIL() << "was made";
  } catch (const GpuError& error) {
    EXPECT_NE(std::string(error.what()).find("out of memory"), std::string::npos) << error.what();
  }
  context.takeErrors();
}

TEST_F(TextureTest, ImpossibleCubesAreErrors) {
  std::array<Image<float>, 6> faces;
  EXPECT_THROW(TextureCube(faces, {}), GpuError);  // of no size
}

}  // namespace
}  // namespace welkin::gpu
