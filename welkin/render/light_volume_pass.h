// SPDX-License-Identifier: Apache-2.0
// Fills the light volume: optical depths towards and away from the sun, up and down, on slices around the eye
// (shaders/lib/light_volume.glsl says how it is laid out). Slices are swept from the top down and then from
// the bottom up, each from its neighbour.
#pragma once

#include "welkin/gpu/draw.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/cloud_textures.h"
#include "welkin/render/programs.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

class LightVolumePass {
 public:
  LightVolumePass();

  // Sweeps the volume of a sky. Keeps its textures for the next sky of the same number of slices.
  void draw(const scene::SkyState& state, const shading::LightVolumeLayout& layout,
            const CloudTextures& clouds);

  const gpu::Texture3D& volume() const { return volume_; }

 private:
  void sweepCascade(const shading::LightVolumeLayout& layout, int cascade, const CloudTextures& clouds);

  gpu::FullscreenTriangle triangle_;
  ProgramVariants up_{"pass/light_volume_up.frag"};
  gpu::Program down_;
  gpu::Texture2D neighbour_[2];  // the last slice swept, and the next
  gpu::Texture3D upward_;        // what the first sweep found
  gpu::Texture3D volume_;
};

}  // namespace welkin::render
