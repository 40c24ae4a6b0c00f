// SPDX-License-Identifier: Apache-2.0
// The tables of the clear sky on the GPU: what lib/sky_uniforms.glsl samples. Kept from sky to sky.
#pragma once

#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {

class SkyTextures {
 public:
  // Computes the tables for a sky and its eye, and uploads them.
  void update(const scene::SkyState& state);
  // Binds those that the program asks for.
  void bind(const gpu::Program& program) const;

 private:
  gpu::Texture2D transmittance_, skyView_, keyLight_;
  gpu::Texture3D inscatter_, through_;
};

}  // namespace welkin::render
