// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/foreign_engine.h"

#include <epoxy/gl.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace welkin::testing {
namespace {

bool hasImages() {
  return epoxy_is_desktop_gl() && epoxy_gl_version() >= 42;
}
bool hasViewports() {
  return epoxy_gl_version() >= 41;
}
bool hasClipControl() {
  return epoxy_gl_version() >= 45;
}

struct Named {
  const char* text;
  GLenum name;
};
constexpr Named kSwitches[] = {{"scissor test", GL_SCISSOR_TEST},
                               {"blending", GL_BLEND},
                               {"depth test", GL_DEPTH_TEST},
                               {"stencil test", GL_STENCIL_TEST},
                               {"culling", GL_CULL_FACE},
                               {"logic operation", GL_COLOR_LOGIC_OP},
                               {"smooth polygons", GL_POLYGON_SMOOTH},
                               {"sRGB", GL_FRAMEBUFFER_SRGB},
                               {"alpha to coverage", GL_SAMPLE_ALPHA_TO_COVERAGE},
                               {"alpha to one", GL_SAMPLE_ALPHA_TO_ONE},
                               {"coverage", GL_SAMPLE_COVERAGE},
                               {"sample mask", GL_SAMPLE_MASK},
                               {"restart", GL_PRIMITIVE_RESTART},
                               {"clip distance 0", GL_CLIP_DISTANCE0},
                               {"clip distance 5", GL_CLIP_DISTANCE0 + 5}};
struct Store {
  const char* text;
  GLenum name;
  GLint fresh, engines;
};
constexpr Store kStores[] = {{"pack alignment", GL_PACK_ALIGNMENT, 4, 8},
                             {"pack row length", GL_PACK_ROW_LENGTH, 0, 20},
                             {"pack image height", GL_PACK_IMAGE_HEIGHT, 0, 40},
                             {"pack skipped pixels", GL_PACK_SKIP_PIXELS, 0, 2},
                             {"pack skipped rows", GL_PACK_SKIP_ROWS, 0, 4},
                             {"pack skipped images", GL_PACK_SKIP_IMAGES, 0, 1},
                             {"pack swapped", GL_PACK_SWAP_BYTES, 0, 1},
                             {"pack lowest first", GL_PACK_LSB_FIRST, 0, 1},
                             {"unpack alignment", GL_UNPACK_ALIGNMENT, 4, 2},
                             {"unpack row length", GL_UNPACK_ROW_LENGTH, 0, 12},
                             {"unpack image height", GL_UNPACK_IMAGE_HEIGHT, 0, 50},
                             {"unpack skipped pixels", GL_UNPACK_SKIP_PIXELS, 0, 5},
                             {"unpack skipped rows", GL_UNPACK_SKIP_ROWS, 0, 3},
                             {"unpack skipped images", GL_UNPACK_SKIP_IMAGES, 0, 1},
                             {"unpack swapped", GL_UNPACK_SWAP_BYTES, 0, 1},
                             {"unpack lowest first", GL_UNPACK_LSB_FIRST, 0, 1}};

}  // namespace

struct ForeignEngine::Objects {
  GLuint vertexArray = 0, buffer = 0, sampler = 0, plane = 0, volume = 0, framebuffer = 0;
};

ForeignEngine::ForeignEngine() : objects_(std::make_unique<Objects>()) {
  Objects& o = *objects_;
  glGenVertexArrays(1, &o.vertexArray);
  glGenBuffers(1, &o.buffer);
  glGenSamplers(1, &o.sampler);
  glGenTextures(1, &o.plane);
  glGenTextures(1, &o.volume);
  glGenFramebuffers(1, &o.framebuffer);
  glBindTexture(GL_TEXTURE_2D, o.plane);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 16, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glBindFramebuffer(GL_FRAMEBUFFER, o.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, o.plane, 0);
  glBindTexture(GL_TEXTURE_2D, 0);
  restore();
}

ForeignEngine::~ForeignEngine() {
  const Objects& o = *objects_;
  glBindVertexArray(0);
  glDeleteVertexArrays(1, &o.vertexArray);
  glDeleteBuffers(1, &o.buffer);
  glDeleteSamplers(1, &o.sampler);
  glDeleteTextures(1, &o.plane);
  glDeleteTextures(1, &o.volume);
  glDeleteFramebuffers(1, &o.framebuffer);
  for (const Named& s : kSwitches) glDisable(s.name);
  if (hasClipControl()) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glStencilFunc(GL_ALWAYS, 0, ~0u);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glBlendEquation(GL_FUNC_ADD);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  for (const Store& s : kStores) glPixelStorei(s.name, s.fresh);
  if (hasImages())
    for (const GLuint unit : {0u, 1u}) glBindImageTexture(unit, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R8);
  glActiveTexture(GL_TEXTURE0);
}

unsigned ForeignEngine::framebuffer() const {
  return objects_->framebuffer;
}

void ForeignEngine::makeError() {
  glEnable(0xdead);
}

bool ForeignEngine::hasError() {
  return glGetError() == GL_INVALID_ENUM;
}

void ForeignEngine::restore() const {
  const Objects& o = *objects_;
  glBindVertexArray(o.vertexArray);
  glBindBuffer(GL_ARRAY_BUFFER, o.buffer);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, o.buffer);
  glBindFramebuffer(GL_FRAMEBUFFER, o.framebuffer);
  glViewport(1, 2, 3, 4);
  glScissor(5, 6, 7, 8);
  for (const Named& s : kSwitches)
    if (s.name != GL_STENCIL_TEST && s.name != GL_COLOR_LOGIC_OP) glEnable(s.name);
  glSampleMaski(0, 2);
  glSampleCoverage(0.25f, GL_TRUE);
  glPrimitiveRestartIndex(0);
  if (hasClipControl()) glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
  glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
  glColorMaski(2, GL_FALSE, GL_TRUE, GL_TRUE, GL_FALSE);
  glDisablei(GL_BLEND, 1);
  if (hasViewports()) {  // and with them blending by draw buffer
    glBlendFuncSeparatei(1, GL_ONE, GL_SRC_ALPHA, GL_DST_ALPHA, GL_ONE);
    glBlendEquationi(2, GL_MAX);
    glViewportIndexedf(1, 0.5f, 1.5f, 11.0f, 13.0f);
    glScissorIndexed(1, 2, 3, 4, 5);
    glDisablei(GL_SCISSOR_TEST, 2);
  }
  glDepthMask(GL_FALSE);
  glStencilFuncSeparate(GL_FRONT, GL_LESS, 3, 0x0f);
  glStencilFuncSeparate(GL_BACK, GL_GREATER, 5, 0xf0);
  glStencilOpSeparate(GL_FRONT, GL_ZERO, GL_INCR, GL_DECR);
  glStencilOpSeparate(GL_BACK, GL_INVERT, GL_REPLACE, GL_ZERO);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  for (const Store& s : kStores) glPixelStorei(s.name, s.engines);
  for (const GLenum unit : {GL_TEXTURE16, GL_TEXTURE17, GL_TEXTURE18, GL_TEXTURE20}) {
    glActiveTexture(unit);
    glBindTexture(GL_TEXTURE_2D, o.plane);
    glBindTexture(GL_TEXTURE_3D, o.volume);
  }
  glActiveTexture(GL_TEXTURE3);
  glBindTexture(GL_TEXTURE_2D, o.plane);
  glBindTexture(GL_TEXTURE_3D, o.volume);
  glBindSampler(3, o.sampler);
  if (hasImages()) {
    glBindImageTexture(0, o.plane, 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA8);
    glBindImageTexture(1, o.plane, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  }
}

std::map<std::string, std::string> ForeignEngine::state() {
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
  const auto askOf = [&](const char* name, GLenum what, int count, GLuint index) {
    GLfloat v[4] = {0, 0, 0, 0};
    glGetFloati_v(what, index, v);
    std::string& text = state[name + (" " + std::to_string(index))];
    for (int i = 0; i < count; ++i) text += std::to_string(v[i]) + ' ';
  };
  for (const GLuint i : {0u, 1u, 2u, 7u}) {
    askOf("colour mask", GL_COLOR_WRITEMASK, 4, i);
    state["blending " + std::to_string(i)] = glIsEnabledi(GL_BLEND, i) ? "on" : "off";
    if (!hasViewports()) continue;
    askOf("viewport", GL_VIEWPORT, 4, i);
    askOf("scissor box", GL_SCISSOR_BOX, 4, i);
    state["scissor test " + std::to_string(i)] = glIsEnabledi(GL_SCISSOR_TEST, i) ? "on" : "off";
    askOf("blend source", GL_BLEND_SRC_RGB, 1, i);
    askOf("blend source alpha", GL_BLEND_SRC_ALPHA, 1, i);
    askOf("blend target", GL_BLEND_DST_RGB, 1, i);
    askOf("blend target alpha", GL_BLEND_DST_ALPHA, 1, i);
    askOf("blend equation", GL_BLEND_EQUATION_RGB, 1, i);
  }
  ask("viewport", GL_VIEWPORT, 4);
  ask("scissor box", GL_SCISSOR_BOX, 4);
  ask("blend source", GL_BLEND_SRC_RGB, 1);
  ask("blend target alpha", GL_BLEND_DST_ALPHA, 1);
  ask("blend equation", GL_BLEND_EQUATION_RGB, 1);
  if (hasClipControl()) {
    ask("clip origin", GL_CLIP_ORIGIN, 1);
    ask("clip depth", GL_CLIP_DEPTH_MODE, 1);
  }
  ask("depth mask", GL_DEPTH_WRITEMASK, 1);
  ask("stencil function", GL_STENCIL_FUNC, 1);
  ask("stencil reference", GL_STENCIL_REF, 1);
  ask("stencil mask", GL_STENCIL_VALUE_MASK, 1);
  ask("stencil fails", GL_STENCIL_FAIL, 1);
  ask("depth fails", GL_STENCIL_PASS_DEPTH_FAIL, 1);
  ask("stencil passes", GL_STENCIL_PASS_DEPTH_PASS, 1);
  ask("stencil function behind", GL_STENCIL_BACK_FUNC, 1);
  ask("stencil reference behind", GL_STENCIL_BACK_REF, 1);
  ask("stencil mask behind", GL_STENCIL_BACK_VALUE_MASK, 1);
  ask("stencil fails behind", GL_STENCIL_BACK_FAIL, 1);
  ask("depth fails behind", GL_STENCIL_BACK_PASS_DEPTH_FAIL, 1);
  ask("stencil passes behind", GL_STENCIL_BACK_PASS_DEPTH_PASS, 1);
  ask("polygon mode", GL_POLYGON_MODE, 1);
  for (const Store& s : kStores) ask(s.text, s.name, 1);
  ask("active texture", GL_ACTIVE_TEXTURE, 1);
  for (const Named& s : kSwitches) state[s.text] = glIsEnabled(s.name) ? "on" : "off";
  state["seamless cubes"] = glIsEnabled(GL_TEXTURE_CUBE_MAP_SEAMLESS) ? "on" : "off";
  GLint active = 0;
  glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
  for (GLenum i = 0; i < 32; ++i) {
    glActiveTexture(GL_TEXTURE0 + i);
    const std::string unit = "unit " + std::to_string(i);
    ask((unit + " 2D").c_str(), GL_TEXTURE_BINDING_2D, 1);
    ask((unit + " 3D").c_str(), GL_TEXTURE_BINDING_3D, 1);
    ask((unit + " cube").c_str(), GL_TEXTURE_BINDING_CUBE_MAP, 1);
    ask((unit + " sampler").c_str(), GL_SAMPLER_BINDING, 1);
  }
  glActiveTexture(static_cast<GLenum>(active));
  for (GLuint i = 0; hasImages() && i < 2; ++i)
    for (const GLenum what : {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LAYERED, GL_IMAGE_BINDING_ACCESS,
                              GL_IMAGE_BINDING_FORMAT}) {
      GLint value = 0;
      glGetIntegeri_v(what, i, &value);
      state["image " + std::to_string(i) + " " + std::to_string(what)] = std::to_string(value);
    }
  return state;
}

SrgbTarget::SrgbTarget() {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, 64, 36, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  glEnable(GL_FRAMEBUFFER_SRGB);
}

SrgbTarget::~SrgbTarget() {
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
}

double SrgbTarget::meanGreen() const {
  std::vector<float> pixels(64 * 36 * 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glReadPixels(0, 0, 64, 36, GL_RGBA, GL_FLOAT, pixels.data());
  double sum = 0.0;
  for (std::size_t i = 1; i < pixels.size(); i += 4) {
    const auto v = static_cast<double>(pixels[i]);
    sum += v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return sum / (64 * 36);
}

}  // namespace welkin::testing
