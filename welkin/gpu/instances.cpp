// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/instances.h"

#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {

Instances::Instances(int vectors) : vectors_(vectors) {
  glGenVertexArrays(1, &vertexArray_);
  glGenBuffers(1, &buffer_);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  constexpr std::size_t kVector = 4 * sizeof(float);
  for (int i = 0; i < vectors; ++i) {
    const auto at = static_cast<GLuint>(i);
    glEnableVertexAttribArray(at);
    glVertexAttribPointer(at, 4, GL_FLOAT, GL_FALSE,
                          static_cast<GLsizei>(kVector * static_cast<std::size_t>(vectors)),
                          reinterpret_cast<const void*>(kVector * static_cast<std::size_t>(i)));
    glVertexAttribDivisor(at, 1);
  }
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

Instances::~Instances() {
  glDeleteVertexArrays(1, &vertexArray_);
  glDeleteBuffers(1, &buffer_);
}

void Instances::upload(std::span<const float> values) {
  count_ = static_cast<int>(values.size()) / (4 * vectors_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size_bytes()), values.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void Instances::draw(const Program& program, const Target& target, const DrawOptions& options) const {
  if (count_ == 0) return;
  const DrawState state(program, target, options);
  glBindVertexArray(vertexArray_);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
  glBindVertexArray(0);
}

}  // namespace welkin::gpu
