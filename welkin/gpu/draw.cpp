// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/draw.h"

#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {

FullscreenTriangle::FullscreenTriangle() {
  glGenVertexArrays(1, &vertexArray_);
}
FullscreenTriangle::~FullscreenTriangle() {
  glDeleteVertexArrays(1, &vertexArray_);
}

void FullscreenTriangle::draw(const Program& program, const Framebuffer& target,
                              const DrawOptions& options) const {
  target.bind();
  program.use();
  glBindVertexArray(vertexArray_);
  if (options.tile) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(options.tile->x, options.tile->y, options.tile->width, options.tile->height);
  }
  if (options.blend == Blend::kAdd) {
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
  }
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glBindVertexArray(0);
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
