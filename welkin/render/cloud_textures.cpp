// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/cloud_textures.h"

#include <utility>

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

void CloudTextures::bind(gpu::Program& program) const {
  program.bind("uPlacement", placement_);
  program.bind("uShapeNoise", shape_);
  program.bind("uDetailNoise", detail_);
}

}  // namespace welkin::render
