// SPDX-License-Identifier: Apache-2.0
// Meshes, blending, targets within foreign framebuffers, and somebody else's state.
#include "welkin/gpu/mesh.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "welkin/gpu/context.h"
#include "welkin/gpu/state_guard.h"

namespace welkin::gpu {
namespace {

class MeshTest : public testing::Test {
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

// All that an engine may have set, as text, by name.
std::map<std::string, std::string> stateOf() {
  std::map<std::string, std::string> state;
  const auto ask = [&](const char* name, GLenum what, int count) {
    GLint v[4] = {0, 0, 0, 0};
    glGetIntegerv(what, v);
    std::string& text = state[name];
    for (int i = 0; i < count; ++i) text += std::to_string(v[i]) + ' ';
  };
  ask("program", GL_CURRENT_PROGRAM, 1);
  ask("vertex array", GL_VERTEX_ARRAY_BINDING, 1);
  ask("array buffer", GL_ARRAY_BUFFER_BINDING, 1);
  ask("unpack buffer", GL_PIXEL_UNPACK_BUFFER_BINDING, 1);
  ask("pack buffer", GL_PIXEL_PACK_BUFFER_BINDING, 1);
  ask("draw framebuffer", GL_DRAW_FRAMEBUFFER_BINDING, 1);
  ask("read framebuffer", GL_READ_FRAMEBUFFER_BINDING, 1);
  ask("viewport", GL_VIEWPORT, 4);
  ask("scissor box", GL_SCISSOR_BOX, 4);
  ask("blend source", GL_BLEND_SRC_RGB, 1);
  ask("blend target alpha", GL_BLEND_DST_ALPHA, 1);
  ask("blend equation", GL_BLEND_EQUATION_RGB, 1);
  ask("colour mask", GL_COLOR_WRITEMASK, 4);
  ask("depth mask", GL_DEPTH_WRITEMASK, 1);
  ask("polygon mode", GL_POLYGON_MODE, 1);
  ask("unpack alignment", GL_UNPACK_ALIGNMENT, 1);
  ask("unpack row length", GL_UNPACK_ROW_LENGTH, 1);
  ask("pack alignment", GL_PACK_ALIGNMENT, 1);
  ask("active texture", GL_ACTIVE_TEXTURE, 1);
  for (const GLenum name : {GL_SCISSOR_TEST, GL_BLEND, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_CULL_FACE,
                            GL_COLOR_LOGIC_OP, GL_FRAMEBUFFER_SRGB})
    state["switch " + std::to_string(name)] = glIsEnabled(name) ? "on" : "off";
  GLint active = 0;
  glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
  for (GLenum i = 0; i < 16; ++i) {
    glActiveTexture(GL_TEXTURE0 + i);
    const std::string unit = "unit " + std::to_string(i);
    ask((unit + " 2D").c_str(), GL_TEXTURE_BINDING_2D, 1);
    ask((unit + " 3D").c_str(), GL_TEXTURE_BINDING_3D, 1);
    ask((unit + " sampler").c_str(), GL_SAMPLER_BINDING, 1);
  }
  glActiveTexture(static_cast<GLenum>(active));
  return state;
}

TEST_F(MeshTest, AnEnginesStateComesBack) {
  const Texture2D a(4, 4, {}), b(4, 4, {.format = Format::kRgba32F});
  const Texture3D c(2, 2, 2, {});
  const Framebuffer engines(a), ours(b);
  const Program program = flatProgram();
  GLuint vertexArray = 0, buffer = 0, sampler = 0;
  glGenVertexArrays(1, &vertexArray);
  glGenBuffers(1, &buffer);
  glGenSamplers(1, &sampler);
  glBindVertexArray(vertexArray);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
  glBindFramebuffer(GL_FRAMEBUFFER, engines.id());
  glViewport(1, 2, 3, 4);
  glScissor(5, 6, 7, 8);
  for (const GLenum name : {GL_SCISSOR_TEST, GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_FRAMEBUFFER_SRGB})
    glEnable(name);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
  glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 12);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
  glActiveTexture(GL_TEXTURE3);
  glBindTexture(GL_TEXTURE_2D, a.id());
  glBindTexture(GL_TEXTURE_3D, c.id());
  glBindSampler(3, sampler);
  const auto before = stateOf();
  {
    const StateGuard guard;
    leftHalf().draw(program, ours, {.tile = Tile{0, 0, 2, 2}, .blend = Blend::kOver});
    Texture2D uploaded(3, 3, {});
    uploaded.upload(Image<float>(3, 3, 3));
    // Drawn as in a fresh context, whatever the engine had.
    ours.clear();
    leftHalf().draw(program, ours);
    EXPECT_GT(ours.readPicture().at(1, 1, 1), 0.0f);
  }
  EXPECT_EQ(stateOf(), before);
  glBindVertexArray(0);
  glDeleteVertexArrays(1, &vertexArray);
  glDeleteBuffers(1, &buffer);
  glDeleteSamplers(1, &sampler);
}

}  // namespace
}  // namespace welkin::gpu
