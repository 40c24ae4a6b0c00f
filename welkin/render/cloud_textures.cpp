// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/cloud_textures.h"

#include <utility>

#include "welkin/render/programs.h"

namespace welkin::render {
namespace {

gpu::TextureOptions tiling(gpu::Format format) {
  return {.format = format,
          .wrapX = gpu::Wrap::kRepeat,
          .wrapY = gpu::Wrap::kRepeat,
          .wrapZ = gpu::Wrap::kRepeat};
}

}  // namespace

CloudTextures::CloudTextures(std::shared_ptr<const field::CloudNoise> noise)
    : noise_(std::move(noise)),
      placement_(noise_->placement, tiling(gpu::Format::kRgba16F)),
      shape_(noise_->shape, tiling(gpu::Format::kR16F)),
      detail_(noise_->detail, tiling(gpu::Format::kR16F)) {}

void CloudTextures::setBalls(const shading::BallVolume& balls) {
  ballUniforms_ = balls.uniforms;
  if (balls.empty()) return;
  ballShapes_ = gpu::Texture3D(balls.shapes, {.format = gpu::Format::kRg16F});
  ballTable_ =
      gpu::Texture2D(balls.table, {.format = gpu::Format::kRgba32F, .filter = gpu::Filter::kNearest});
}

void CloudTextures::bind(gpu::Program& program) const {
  program.bind("uPlacement", placement_);
  program.bind("uShapeNoise", shape_);
  program.bind("uDetailNoise", detail_);
  if (ballUniforms_.empty()) return;
  setUniforms(program, ballUniforms_);
  program.bind("uBallShapes", ballShapes_);
  program.bind("uBallTable", ballTable_);
}

}  // namespace welkin::render
