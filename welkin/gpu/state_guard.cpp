// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/state_guard.h"

#include <algorithm>
#include <iterator>

#include "welkin/gpu/context.h"
#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {
namespace {

struct Switch {
  GLenum name;
  int since;  // version of OpenGL, major * 10 + minor
};
// All off in a fresh context.
constexpr Switch kAllSwitches[] = {{GL_DEPTH_TEST, 10},
                                   {GL_STENCIL_TEST, 10},
                                   {GL_CULL_FACE, 10},
                                   {GL_COLOR_LOGIC_OP, 11},
                                   {GL_POLYGON_SMOOTH, 10},
                                   {GL_RASTERIZER_DISCARD, 30},
                                   {GL_SAMPLE_ALPHA_TO_COVERAGE, 13},
                                   {GL_SAMPLE_ALPHA_TO_ONE, 13},
                                   {GL_SAMPLE_COVERAGE, 13},
                                   {GL_SAMPLE_MASK, 32},
                                   {GL_SAMPLE_SHADING, 40},
                                   {GL_PRIMITIVE_RESTART, 31},
                                   {GL_PRIMITIVE_RESTART_FIXED_INDEX, 43}};

// Since when there are more than one viewport, blending by draw buffer, images.
constexpr int kViewportsSince = 41, kBlendsSince = 40, kImagesSince = 42;

struct PixelStore {
  GLenum name;
  GLint fresh;
};
constexpr PixelStore kAllPixelStores[] = {
    {GL_PACK_ALIGNMENT, 4},    {GL_PACK_ROW_LENGTH, 0},     {GL_PACK_IMAGE_HEIGHT, 0},
    {GL_PACK_SKIP_PIXELS, 0},  {GL_PACK_SKIP_ROWS, 0},      {GL_PACK_SKIP_IMAGES, 0},
    {GL_PACK_SWAP_BYTES, 0},   {GL_PACK_LSB_FIRST, 0},      {GL_UNPACK_ALIGNMENT, 4},
    {GL_UNPACK_ROW_LENGTH, 0}, {GL_UNPACK_IMAGE_HEIGHT, 0}, {GL_UNPACK_SKIP_PIXELS, 0},
    {GL_UNPACK_SKIP_ROWS, 0},  {GL_UNPACK_SKIP_IMAGES, 0},  {GL_UNPACK_SWAP_BYTES, 0},
    {GL_UNPACK_LSB_FIRST, 0}};

int integer(GLenum name) {
  GLint value[2] = {0, 0};  // GL_POLYGON_MODE writes two in some drivers
  glGetIntegerv(name, value);
  return value[0];
}

int integerOf(GLenum name, int index) {
  GLint value = 0;
  glGetIntegeri_v(name, static_cast<GLuint>(index), &value);
  return value;
}

void enable(GLenum name, bool on) {
  on ? glEnable(name) : glDisable(name);
}

void enableOf(GLenum name, GLuint index, bool on) {
  on ? glEnablei(name, index) : glDisablei(name, index);
}

}  // namespace

StateGuard::StateGuard()
    : version_((requireCurrent(), epoxy_gl_version())),
      hasClipControl_(version_ >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control")),
      drawBuffers_(std::min(integer(GL_MAX_DRAW_BUFFERS), kDrawBuffers)),
      viewports_(version_ >= kViewportsSince ? std::min(integer(GL_MAX_VIEWPORTS), kViewports) : 1),
      clipDistances_(std::min(integer(GL_MAX_CLIP_DISTANCES), kClipDistances)) {
  program_ = integer(GL_CURRENT_PROGRAM);
  vertexArray_ = integer(GL_VERTEX_ARRAY_BINDING);
  arrayBuffer_ = integer(GL_ARRAY_BUFFER_BINDING);
  packBuffer_ = integer(GL_PIXEL_PACK_BUFFER_BINDING);
  unpackBuffer_ = integer(GL_PIXEL_UNPACK_BUFFER_BINDING);
  drawFramebuffer_ = integer(GL_DRAW_FRAMEBUFFER_BINDING);
  readFramebuffer_ = integer(GL_READ_FRAMEBUFFER_BINDING);
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
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask_);
  if (hasClipControl_) {
    clipOrigin_ = integer(GL_CLIP_ORIGIN);
    clipDepth_ = integer(GL_CLIP_DEPTH_MODE);
  }
  static_assert(std::size(kAllSwitches) == kSwitches && std::size(kAllPixelStores) == kPixelStores);
  for (int i = 0; i < kSwitches; ++i)
    enabled_[i] = version_ >= kAllSwitches[i].since && glIsEnabled(kAllSwitches[i].name);
  for (int i = 0; i < clipDistances_; ++i)
    clips_[i] = glIsEnabled(GL_CLIP_DISTANCE0 + static_cast<GLenum>(i));
  for (int i = 0; i < kPixelStores; ++i) pixelStore_[i] = integer(kAllPixelStores[i].name);
  seamless_ = glIsEnabled(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  keepDrawBuffers();
  keepViewports();
  keepTextures();
  setFresh();
}

void StateGuard::keepDrawBuffers() {
  for (int i = 0; i < drawBuffers_; ++i) {
    DrawBuffer& b = buffers_[i];
    b.blends = glIsEnabledi(GL_BLEND, static_cast<GLuint>(i));
    glGetBooleani_v(GL_COLOR_WRITEMASK, static_cast<GLuint>(i), b.mask);
    const auto of = [&](GLenum name) {
      return version_ >= kBlendsSince ? integerOf(name, i) : integer(name);
    };
    b.source[0] = of(GL_BLEND_SRC_RGB);
    b.source[1] = of(GL_BLEND_SRC_ALPHA);
    b.target[0] = of(GL_BLEND_DST_RGB);
    b.target[1] = of(GL_BLEND_DST_ALPHA);
    b.equation[0] = of(GL_BLEND_EQUATION_RGB);
    b.equation[1] = of(GL_BLEND_EQUATION_ALPHA);
  }
}

void StateGuard::keepViewports() {
  if (version_ < kViewportsSince) {
    glGetFloatv(GL_VIEWPORT, areas_[0].area);
    glGetIntegerv(GL_SCISSOR_BOX, areas_[0].scissor);
    areas_[0].cuts = glIsEnabled(GL_SCISSOR_TEST);
    return;
  }
  for (int i = 0; i < viewports_; ++i) {
    const auto index = static_cast<GLuint>(i);
    glGetFloati_v(GL_VIEWPORT, index, areas_[i].area);
    glGetIntegeri_v(GL_SCISSOR_BOX, index, areas_[i].scissor);
    areas_[i].cuts = glIsEnabledi(GL_SCISSOR_TEST, index);
  }
}

void StateGuard::keepTextures() {
  activeTexture_ = integer(GL_ACTIVE_TEXTURE);
  for (int i = 0; i < kUnits; ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    units_[i] = {integer(GL_TEXTURE_BINDING_2D), integer(GL_TEXTURE_BINDING_3D),
                 integer(GL_TEXTURE_BINDING_CUBE_MAP), integer(GL_SAMPLER_BINDING)};
    glBindSampler(static_cast<GLuint>(i), 0);
  }
  for (int i = 0; version_ >= kImagesSince && i < kImageUnits; ++i)
    images_[i] = {integerOf(GL_IMAGE_BINDING_NAME, i),    integerOf(GL_IMAGE_BINDING_LEVEL, i),
                  integerOf(GL_IMAGE_BINDING_LAYERED, i), integerOf(GL_IMAGE_BINDING_LAYER, i),
                  integerOf(GL_IMAGE_BINDING_ACCESS, i),  integerOf(GL_IMAGE_BINDING_FORMAT, i)};
}

void StateGuard::setFresh() const {
  for (int i = 0; i < kSwitches; ++i)
    if (enabled_[i]) glDisable(kAllSwitches[i].name);
  for (int i = 0; i < clipDistances_; ++i)
    if (clips_[i]) glDisable(GL_CLIP_DISTANCE0 + static_cast<GLenum>(i));
  for (const PixelStore& store : kAllPixelStores) glPixelStorei(store.name, store.fresh);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  glActiveTexture(GL_TEXTURE0);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  if (hasClipControl_) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

StateGuard::~StateGuard() {
  restoreTextures();
  for (int i = 0; i < kSwitches; ++i)
    if (version_ >= kAllSwitches[i].since) enable(kAllSwitches[i].name, enabled_[i]);
  for (int i = 0; i < clipDistances_; ++i) enable(GL_CLIP_DISTANCE0 + static_cast<GLenum>(i), clips_[i]);
  for (int i = 0; i < kPixelStores; ++i) glPixelStorei(kAllPixelStores[i].name, pixelStore_[i]);
  enable(GL_TEXTURE_CUBE_MAP_SEAMLESS, seamless_);
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
  if (hasClipControl_) glClipControl(static_cast<GLenum>(clipOrigin_), static_cast<GLenum>(clipDepth_));
  restoreDrawBuffers();
  restoreViewports();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(drawFramebuffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(readFramebuffer_));
  glBindVertexArray(static_cast<GLuint>(vertexArray_));
  glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(arrayBuffer_));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(packBuffer_));
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpackBuffer_));
  glUseProgram(static_cast<GLuint>(program_));
}

void StateGuard::restoreDrawBuffers() const {
  for (int i = 0; i < drawBuffers_; ++i) {
    const DrawBuffer& b = buffers_[i];
    const auto index = static_cast<GLuint>(i);
    enableOf(GL_BLEND, index, b.blends);
    glColorMaski(index, b.mask[0], b.mask[1], b.mask[2], b.mask[3]);
    if (version_ < kBlendsSince) continue;
    glBlendEquationSeparatei(index, static_cast<GLenum>(b.equation[0]), static_cast<GLenum>(b.equation[1]));
    glBlendFuncSeparatei(index, static_cast<GLenum>(b.source[0]), static_cast<GLenum>(b.target[0]),
                         static_cast<GLenum>(b.source[1]), static_cast<GLenum>(b.target[1]));
  }
  if (version_ >= kBlendsSince) return;
  const DrawBuffer& b = buffers_[0];
  glBlendEquationSeparate(static_cast<GLenum>(b.equation[0]), static_cast<GLenum>(b.equation[1]));
  glBlendFuncSeparate(static_cast<GLenum>(b.source[0]), static_cast<GLenum>(b.target[0]),
                      static_cast<GLenum>(b.source[1]), static_cast<GLenum>(b.target[1]));
}

void StateGuard::restoreViewports() const {
  if (version_ < kViewportsSince) {
    const Viewport& v = areas_[0];
    glViewport(static_cast<GLint>(v.area[0]), static_cast<GLint>(v.area[1]), static_cast<GLsizei>(v.area[2]),
               static_cast<GLsizei>(v.area[3]));
    glScissor(v.scissor[0], v.scissor[1], v.scissor[2], v.scissor[3]);
    enable(GL_SCISSOR_TEST, v.cuts);
    return;
  }
  for (int i = 0; i < viewports_; ++i) {
    const auto index = static_cast<GLuint>(i);
    glViewportIndexedfv(index, areas_[i].area);
    glScissorIndexedv(index, areas_[i].scissor);
    enableOf(GL_SCISSOR_TEST, index, areas_[i].cuts);
  }
}

void StateGuard::restoreTextures() const {
  for (int i = 0; i < kUnits; ++i) {
    const Unit& unit = units_[i];
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(unit.texture2D));
    glBindTexture(GL_TEXTURE_3D, static_cast<GLuint>(unit.texture3D));
    glBindTexture(GL_TEXTURE_CUBE_MAP, static_cast<GLuint>(unit.textureCube));
    glBindSampler(static_cast<GLuint>(i), static_cast<GLuint>(unit.sampler));
  }
  glActiveTexture(static_cast<GLenum>(activeTexture_));
  for (int i = 0; version_ >= kImagesSince && i < kImageUnits; ++i) {
    const ImageUnit& image = images_[i];
    glBindImageTexture(static_cast<GLuint>(i), static_cast<GLuint>(image.texture), image.level,
                       static_cast<GLboolean>(image.layered), image.layer, static_cast<GLenum>(image.access),
                       static_cast<GLenum>(image.format));
  }
}

}  // namespace welkin::gpu
