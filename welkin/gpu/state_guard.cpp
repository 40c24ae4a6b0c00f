// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/state_guard.h"

#include <iterator>

#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {
namespace {

// All off in a fresh context.
constexpr GLenum kSwitches[] = {GL_SCISSOR_TEST,       GL_BLEND,           GL_DEPTH_TEST,
                                GL_STENCIL_TEST,       GL_CULL_FACE,       GL_COLOR_LOGIC_OP,
                                GL_RASTERIZER_DISCARD, GL_FRAMEBUFFER_SRGB};

int integer(GLenum name) {
  GLint value[2] = {0, 0};  // GL_POLYGON_MODE writes two in some drivers
  glGetIntegerv(name, value);
  return value[0];
}

int integerOf(GLenum name, int unit) {
  GLint value = 0;
  glGetIntegeri_v(name, static_cast<GLuint>(unit), &value);
  return value;
}

void enable(GLenum name, bool on) {
  on ? glEnable(name) : glDisable(name);
}

}  // namespace

StateGuard::StateGuard() {
  program_ = integer(GL_CURRENT_PROGRAM);
  vertexArray_ = integer(GL_VERTEX_ARRAY_BINDING);
  arrayBuffer_ = integer(GL_ARRAY_BUFFER_BINDING);
  packBuffer_ = integer(GL_PIXEL_PACK_BUFFER_BINDING);
  unpackBuffer_ = integer(GL_PIXEL_UNPACK_BUFFER_BINDING);
  drawFramebuffer_ = integer(GL_DRAW_FRAMEBUFFER_BINDING);
  readFramebuffer_ = integer(GL_READ_FRAMEBUFFER_BINDING);
  glGetIntegerv(GL_VIEWPORT, viewport_);
  glGetIntegerv(GL_SCISSOR_BOX, scissor_);
  blendSource_[0] = integer(GL_BLEND_SRC_RGB);
  blendSource_[1] = integer(GL_BLEND_SRC_ALPHA);
  blendTarget_[0] = integer(GL_BLEND_DST_RGB);
  blendTarget_[1] = integer(GL_BLEND_DST_ALPHA);
  blendEquation_[0] = integer(GL_BLEND_EQUATION_RGB);
  blendEquation_[1] = integer(GL_BLEND_EQUATION_ALPHA);
  packAlignment_ = integer(GL_PACK_ALIGNMENT);
  unpackAlignment_ = integer(GL_UNPACK_ALIGNMENT);
  unpackRowLength_ = integer(GL_UNPACK_ROW_LENGTH);
  polygonMode_ = integer(GL_POLYGON_MODE);
  stencil_[0] = {integer(GL_STENCIL_FUNC),
                 integer(GL_STENCIL_REF),
                 integer(GL_STENCIL_VALUE_MASK),
                 integer(GL_STENCIL_FAIL),
                 integer(GL_STENCIL_PASS_DEPTH_FAIL),
                 integer(GL_STENCIL_PASS_DEPTH_PASS)};
  stencil_[1] = {integer(GL_STENCIL_BACK_FUNC),
                 integer(GL_STENCIL_BACK_REF),
                 integer(GL_STENCIL_BACK_VALUE_MASK),
                 integer(GL_STENCIL_BACK_FAIL),
                 integer(GL_STENCIL_BACK_PASS_DEPTH_FAIL),
                 integer(GL_STENCIL_BACK_PASS_DEPTH_PASS)};
  glGetBooleanv(GL_COLOR_WRITEMASK, colourMask_);
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask_);
  static_assert(std::size(kSwitches) == sizeof(enabled_));
  for (std::size_t i = 0; i < std::size(kSwitches); ++i) {
    enabled_[i] = glIsEnabled(kSwitches[i]);
    glDisable(kSwitches[i]);
  }
  seamless_ = glIsEnabled(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  activeTexture_ = integer(GL_ACTIVE_TEXTURE);
  for (int i = 0; i < kUnits; ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    units_[i] = {integer(GL_TEXTURE_BINDING_2D), integer(GL_TEXTURE_BINDING_3D),
                 integer(GL_TEXTURE_BINDING_CUBE_MAP), integer(GL_SAMPLER_BINDING)};
    glBindSampler(static_cast<GLuint>(i), 0);
  }
  hasImages_ = epoxy_is_desktop_gl() && epoxy_gl_version() >= 42;
  for (int i = 0; hasImages_ && i < kImageUnits; ++i)
    images_[i] = {integerOf(GL_IMAGE_BINDING_NAME, i),    integerOf(GL_IMAGE_BINDING_LEVEL, i),
                  integerOf(GL_IMAGE_BINDING_LAYERED, i), integerOf(GL_IMAGE_BINDING_LAYER, i),
                  integerOf(GL_IMAGE_BINDING_ACCESS, i),  integerOf(GL_IMAGE_BINDING_FORMAT, i)};

  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

StateGuard::~StateGuard() {
  for (int i = 0; i < kUnits; ++i) {
    const auto& unit = units_[i];
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(unit.texture2D));
    glBindTexture(GL_TEXTURE_3D, static_cast<GLuint>(unit.texture3D));
    glBindTexture(GL_TEXTURE_CUBE_MAP, static_cast<GLuint>(unit.textureCube));
    glBindSampler(static_cast<GLuint>(i), static_cast<GLuint>(unit.sampler));
  }
  glActiveTexture(static_cast<GLenum>(activeTexture_));
  for (int i = 0; hasImages_ && i < kImageUnits; ++i) {
    const auto& image = images_[i];
    glBindImageTexture(static_cast<GLuint>(i), static_cast<GLuint>(image.texture), image.level,
                       static_cast<GLboolean>(image.layered), image.layer, static_cast<GLenum>(image.access),
                       static_cast<GLenum>(image.format));
  }
  enable(GL_TEXTURE_CUBE_MAP_SEAMLESS, seamless_);
  for (std::size_t i = 0; i < std::size(kSwitches); ++i) enable(kSwitches[i], enabled_[i]);
  glColorMask(colourMask_[0], colourMask_[1], colourMask_[2], colourMask_[3]);
  glDepthMask(depthMask_);
  for (int i = 0; i < 2; ++i) {
    const GLenum face = i == 0 ? GL_FRONT : GL_BACK;
    const Stencil& kept = stencil_[i];
    glStencilFuncSeparate(face, static_cast<GLenum>(kept.function), kept.reference,
                          static_cast<GLuint>(kept.mask));
    glStencilOpSeparate(face, static_cast<GLenum>(kept.fail), static_cast<GLenum>(kept.depthFail),
                        static_cast<GLenum>(kept.pass));
  }
  glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygonMode_));
  glPixelStorei(GL_PACK_ALIGNMENT, packAlignment_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, unpackAlignment_);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, unpackRowLength_);
  glBlendEquationSeparate(static_cast<GLenum>(blendEquation_[0]), static_cast<GLenum>(blendEquation_[1]));
  glBlendFuncSeparate(static_cast<GLenum>(blendSource_[0]), static_cast<GLenum>(blendTarget_[0]),
                      static_cast<GLenum>(blendSource_[1]), static_cast<GLenum>(blendTarget_[1]));
  glScissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(drawFramebuffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(readFramebuffer_));
  glBindVertexArray(static_cast<GLuint>(vertexArray_));
  glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(arrayBuffer_));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(packBuffer_));
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpackBuffer_));
  glUseProgram(static_cast<GLuint>(program_));
}

}  // namespace welkin::gpu
