// SPDX-License-Identifier: Apache-2.0
// Triangles with attributes of floats, in the context's memory.
#pragma once

#include <cstdint>
#include <span>

#include "welkin/gpu/draw.h"

namespace welkin::gpu {

class Mesh {
 public:
  Mesh() = default;  // no triangles: for members that are filled later
  // vertices: attributes interleaved; attribute i has attributeSizes[i] floats (1 to 4) and is the shader's
  // `layout(location = i) in`. indices: three a triangle, each below the number of vertices.
  Mesh(std::span<const float> vertices, std::span<const int> attributeSizes,
       std::span<const std::uint32_t> indices);
  ~Mesh();
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;
  Mesh(Mesh&& other) noexcept;
  Mesh& operator=(Mesh&& other) noexcept;

  bool empty() const { return count_ == 0; }

  // Binds the target and draws all triangles, whichever way they face. Textures are bound already.
  void draw(const Program& program, const Target& target, const DrawOptions& options = {}) const;

 private:
  unsigned vertexArray_ = 0, vertexBuffer_ = 0, indexBuffer_ = 0;
  int count_ = 0;
};

}  // namespace welkin::gpu
