// SPDX-License-Identifier: Apache-2.0
// Many quads in one draw, each with a few floats of its own that change from frame to frame.
#pragma once

#include <span>

#include "welkin/gpu/draw.h"

namespace welkin::gpu {

class Instances {
 public:
  // An instance has `vectors` attributes of four floats, the shader's `layout(location = i) in vec4`. Its
  // corners are told apart by gl_VertexID, 0 to 3, as a triangle strip has them.
  explicit Instances(int vectors);
  ~Instances();
  Instances(const Instances&) = delete;
  Instances& operator=(const Instances&) = delete;

  // Instance by instance. Allocates nothing here.
  void upload(std::span<const float> values);

  // Binds the target and draws all, in their order. Textures are bound already.
  void draw(const Program& program, const Target& target, const DrawOptions& options) const;

 private:
  unsigned vertexArray_ = 0, buffer_ = 0;
  int vectors_ = 1, count_ = 0;
};

}  // namespace welkin::gpu
