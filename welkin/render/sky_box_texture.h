// SPDX-License-Identifier: Apache-2.0
// A sky box of the user's on the device: what lib/background.glsl samples under WELKIN_SKY_BOX.
#pragma once

#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/scene/sky_box.h"

namespace welkin::render {

class SkyBoxTexture {
 public:
  // The box is not empty. Throws as scene::skyBoxFaces() does, and GpuError.
  explicit SkyBoxTexture(const scene::SkyBox& box);

  const scene::SkyBox& box() const { return box_; }
  void bind(gpu::Program& program) const;  // sets its uniforms, too

 private:
  scene::SkyBox box_;
  gpu::TextureCube faces_;
  float scale_ = 1.0f;  // cd/m2 of 1
};

}  // namespace welkin::render
