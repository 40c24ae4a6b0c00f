// SPDX-License-Identifier: Apache-2.0
// Fills the light volume: optical depths towards and away from the sun, up and down, on slices around the eye
// (shaders/lib/light_volume.glsl says how it is laid out), the widest cascade first. Slices are swept from
// the top down and then from the bottom up, each from its neighbour. Then, by what was swept, the fluence
// (lib/fluence.glsl) and the light on the ground (lib/ground_light.glsl).
#pragma once

#include <array>
#include <vector>

#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/cloud_textures.h"
#include "welkin/render/fluence_pass.h"
#include "welkin/render/ground_light_pass.h"
#include "welkin/render/programs.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

class LightVolumePass {
 public:
  LightVolumePass();

  // Sweeps the volume of a sky. Keeps its textures for the next sky of the same number of slices. Pictures
  // that are lit by others' approximations ask for no fluence.
  enum class Spread { kNo, kYes };
  void draw(const scene::SkyState& state, const shading::LightVolumeLayout& layout,
            const CloudTextures& clouds, Spread spread = Spread::kYes);

  // The same a few slices at a time, for frame loops: begin(), then advance() until it returns true. Until
  // then volume(), fluence() and groundShares() are what was swept before. clouds: the layers,
  // shading::cloudUniforms() or what has changed of them. After the first volume of a layout nothing is
  // compiled or allocated.
  void begin(const shading::Uniforms& layers, const shading::LightVolumeLayout& layout,
             Spread spread = Spread::kYes);
  bool advance(int parts, const CloudTextures& clouds);  // about `parts` of kParts
  // Makes room for the next volume beside the one that was swept, which begin() does otherwise.
  void makeNext();
  bool inProgress() const { return step_ < steps(); }
  static constexpr int kParts = 256;

  const gpu::Texture3D& volume() const { return volumes_[front_]; }
  const gpu::Texture3D& fluence() const { return fluence_.fluence(); }
  const gpu::Texture2D& groundShares() const { return ground_.shares(); }

 private:
  int sweeps() const;   // slices, down and up
  int spreads() const;  // steps of the fluence
  int steps() const;
  void step(int step, const CloudTextures& clouds);
  void sweepStep(int step, const CloudTextures& clouds);
  float costOfAll() const;
  float cost(int step) const;

  gpu::FullscreenTriangle triangle_;
  ProgramVariants up_{"pass/light_volume_up.frag"};
  std::vector<gpu::Program*> upOfBand_;
  gpu::Program down_;
  // The last slice swept, and the next.
  std::array<gpu::Texture2D, 2> neighbours_;
  std::array<gpu::Framebuffer, 2> targets_;
  int last_ = 0;
  gpu::Texture3D upward_;  // what the first sweep found
  std::array<gpu::Texture3D, 2> volumes_;
  std::size_t front_ = 0;
  FluencePass fluence_;
  GroundLightPass ground_;
  Spread spread_ = Spread::kYes;
  shading::LightVolumeLayout layout_;  // being swept
  int step_ = 0;
  float credit_ = 0.0f;  // of steps, not yet used
};

}  // namespace welkin::render
