// SPDX-License-Identifier: Apache-2.0
// The noise of clouds on the GPU, in half floats (8-bit textures are filtered to 8 bits by software
// rasterisers, and band), and metaballs that are drawn as volumes.
#pragma once

#include <memory>

#include "welkin/field/cloud_field.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/shading/ball_volume.h"

namespace welkin::render {

class CloudTextures {
 public:
  explicit CloudTextures(std::shared_ptr<const field::CloudNoise> noise);

  // The noise that these are made of; compare to know whether they still serve.
  const std::shared_ptr<const field::CloudNoise>& noise() const { return noise_; }
  void setBalls(const shading::BallVolume& balls);
  void bind(gpu::Program& program) const;

 private:
  std::shared_ptr<const field::CloudNoise> noise_;
  gpu::Texture2D placement_;
  gpu::Texture3D shape_, detail_;
  gpu::Texture3D ballShapes_;
  gpu::Texture2D ballTable_;
  shading::Uniforms ballUniforms_;
};

}  // namespace welkin::render
