// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/mesh.h"

#include <numeric>
#include <utility>

#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {

Mesh::Mesh(std::span<const float> vertices, std::span<const int> attributeSizes,
           std::span<const std::uint32_t> indices)
    : count_(static_cast<int>(indices.size())) {
  glGenVertexArrays(1, &vertexArray_);
  glGenBuffers(1, &vertexBuffer_);
  glGenBuffers(1, &indexBuffer_);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()), vertices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size_bytes()), indices.data(),
               GL_STATIC_DRAW);
  const std::size_t stride =
      static_cast<std::size_t>(std::accumulate(attributeSizes.begin(), attributeSizes.end(), 0)) *
      sizeof(float);
  std::size_t offset = 0;
  for (std::size_t i = 0; i < attributeSizes.size(); ++i) {
    glEnableVertexAttribArray(static_cast<GLuint>(i));
    glVertexAttribPointer(static_cast<GLuint>(i), attributeSizes[i], GL_FLOAT, GL_FALSE,
                          static_cast<GLsizei>(stride), reinterpret_cast<const void*>(offset));
    offset += static_cast<std::size_t>(attributeSizes[i]) * sizeof(float);
  }
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

Mesh::~Mesh() {
  if (!vertexArray_) return;
  glDeleteVertexArrays(1, &vertexArray_);
  const GLuint buffers[] = {vertexBuffer_, indexBuffer_};
  glDeleteBuffers(2, buffers);
}

Mesh::Mesh(Mesh&& other) noexcept {
  *this = std::move(other);
}

Mesh& Mesh::operator=(Mesh&& other) noexcept {
  std::swap(vertexArray_, other.vertexArray_);
  std::swap(vertexBuffer_, other.vertexBuffer_);
  std::swap(indexBuffer_, other.indexBuffer_);
  std::swap(count_, other.count_);
  return *this;
}

void Mesh::draw(const Program& program, const Target& target, const DrawOptions& options) const {
  if (empty()) return;
  const DrawState state(program, target, options);
  glBindVertexArray(vertexArray_);
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
}

}  // namespace welkin::gpu
