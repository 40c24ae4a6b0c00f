// SPDX-License-Identifier: Apache-2.0
// Meshes, blending, targets within foreign framebuffers, and somebody else's state.
#include "welkin/gpu/mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "tests/testing/foreign_engine.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/state_guard.h"

namespace welkin::gpu {
namespace {

class MeshTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }
  Context context{{.debug = true}};
};

Program flatProgram() {
  return Program::graphics({R"(#version 330 core
layout(location = 0) in vec2 iPosition;
layout(location = 1) in float iAlpha;
out float vAlpha;
void main() { gl_Position = vec4(iPosition, 0.0, 1.0); vAlpha = iAlpha; }
)",
                            {"flat.vert"}},
                           {R"(#version 330 core
in float vAlpha;
layout(location = 0) out vec4 oColour;
void main() { oColour = vec4(vec3(0.5) * vAlpha, vAlpha); }
)",
                            {"flat.frag"}});
}

// A quad over the left half, alpha 0 at its left edge and 1 at its right.
Mesh leftHalf() {
  const std::array<float, 12> vertices = {-1, -1, 0, 0, -1, 1, -1, 1, 0, 0, 1, 1};
  const std::array<std::uint32_t, 6> indices = {0, 1, 2, 2, 1, 3};
  const std::array<int, 2> sizes = {2, 1};
  return {vertices, sizes, indices};
}

TEST_F(MeshTest, DrawsOverWhatIsThereByItsAlpha) {
  const Program program = flatProgram();
  const Mesh mesh = leftHalf();
  const Texture2D texture(8, 4, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  target.clear(0, {1, 1, 1, 1});
  mesh.draw(program, target, {.blend = Blend::kOver});
  const Image<float> got = target.readPicture();
  for (int x = 0; x < 8; ++x) {
    const float alpha = x < 4 ? (static_cast<float>(x) + 0.5f) / 4.0f : 0.0f;
    EXPECT_NEAR(got.at(x, 1, 0), 0.5f * alpha + (1.0f - alpha), 1e-5f) << x;
  }
}

TEST_F(MeshTest, DrawsIntoAPartOfAForeignFramebuffer) {
  const Program program = flatProgram();
  const Mesh mesh = leftHalf();
  const Texture2D texture(8, 4, {.format = Format::kRgba32F});
  const Framebuffer framebuffer(texture);
  framebuffer.clear(0, {-1, -1, -1, -1});
  mesh.draw(program, Target(framebuffer.id(), {4, 0, 4, 4}));
  const Image<float> got = framebuffer.readPicture();
  EXPECT_EQ(got.at(3, 0, 0), -1.0f);
  EXPECT_GT(got.at(4, 0, 0), 0.0f);
  EXPECT_EQ(got.at(6, 0, 0), -1.0f);
}

TEST_F(MeshTest, AnEmptyMeshDrawsNothing) {
  Mesh mesh;
  EXPECT_TRUE(mesh.empty());
  const Texture2D texture(2, 2, {});
  const Framebuffer target(texture);
  mesh.draw(flatProgram(), target);
}

TEST_F(MeshTest, AnEnginesStateComesBack) {
  const Texture2D texture(4, 4, {.format = Format::kRgba32F});
  Framebuffer ours(texture);
  const Program program = flatProgram();
  const Mesh mesh = leftHalf();
  const testing::ForeignEngine engine;
  const auto before = engine.state();
  {
    const StateGuard guard;
    mesh.draw(program, ours, {.tile = Tile{0, 0, 2, 2}, .blend = Blend::kOver});
    Texture2D uploaded(3, 3, {});
    uploaded.upload(Image<float>(3, 3, 3));
    ours.setMask(Image<std::uint8_t>(4, 4, 1));
    mesh.draw(program, ours, {.where = 2});
    // Drawn as in a fresh context, whatever the engine had.
    ours.clear();
    mesh.draw(program, ours);
    EXPECT_GT(ours.readPicture().at(1, 1, 1), 0.0f);
  }
  EXPECT_EQ(engine.state(), before);
}

// Whatever draws and uploads depend on is as it was made; what is bound they bind themselves.
TEST_F(MeshTest, InsideAGuardTheContextIsFresh) {
  auto fresh = testing::ForeignEngine::state();
  const testing::ForeignEngine engine;
  const auto engines = engine.state();
  const StateGuard guard;
  auto inside = engine.state();
  int told = 0;
  for (const auto& [name, value] : fresh) {
    told += engines.at(name) != value;
    for (const char* kind : {"unit ", "image ", "viewport", "scissor box", "blend ", "stencil ", "depth mask",
                             "depth fails", "vertex array", "array buffer", "draw framebuffer",
                             "read framebuffer", "program", "seamless", "sRGB"})
      if (name.starts_with(kind)) inside[name] = value;
    EXPECT_EQ(inside[name], value) << name;
  }
  EXPECT_GT(told, 60);
}

}  // namespace
}  // namespace welkin::gpu
