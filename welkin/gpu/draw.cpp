// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/draw.h"

#include "welkin/gpu/context.h"
#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {

DrawState::DrawState(const Program& program, const Target& target, const DrawOptions& options) {
  Framebuffer::bindArea(target.framebuffer, target.area.x, target.area.y, target.area.width,
                        target.area.height);
  program.use();
  if (options.tile) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(target.area.x + options.tile->x, target.area.y + options.tile->y, options.tile->width,
              options.tile->height);
  }
  if (options.where) {
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_EQUAL, *options.where, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  }
  if (options.blend != Blend::kReplace) {
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, options.blend == Blend::kAdd ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
  }
}

DrawState::~DrawState() {
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
}

FullscreenTriangle::FullscreenTriangle() {
  glGenVertexArrays(1, &vertexArray_);
}
FullscreenTriangle::~FullscreenTriangle() {
  glDeleteVertexArrays(1, &vertexArray_);
}

void FullscreenTriangle::draw(const Program& program, const Target& target,
                              const DrawOptions& options) const {
  const DrawState state(program, target, options);
  glBindVertexArray(vertexArray_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

bool canCompute() {
  return epoxy_is_desktop_gl() && epoxy_gl_version() >= 43;
}

bool isSoftware() {
  const auto* device = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return device && isSoftwareDevice(device);
}

void bindImage(int unit, const Texture& texture, Access access) {
  constexpr GLenum kAccess[] = {GL_READ_ONLY, GL_WRITE_ONLY, GL_READ_WRITE};
  glBindImageTexture(static_cast<GLuint>(unit), texture.id(), 0, texture.target() == GL_TEXTURE_3D, 0,
                     kAccess[static_cast<int>(access)], internalFormat(texture.options().format));
}

void dispatch(const Program& program, int groupsX, int groupsY, int groupsZ) {
  program.use();
  glDispatchCompute(static_cast<GLuint>(groupsX), static_cast<GLuint>(groupsY), static_cast<GLuint>(groupsZ));
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void flush() {
  glFlush();
}
void finish() {
  glFinish();
}

Stopwatch::Stopwatch() {
  glFinish();
  start_ = std::chrono::steady_clock::now();
}

double Stopwatch::finishedMs() {
  glFinish();
  const auto now = std::chrono::steady_clock::now();
  const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
  start_ = now;
  return ms;
}

}  // namespace welkin::gpu
