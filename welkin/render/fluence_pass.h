// SPDX-License-Identifier: Apache-2.0
// Spreads the sun's light through the clouds of a light volume (shaders/lib/fluence.glsl): from the widest
// cascade to the narrowest, each by steps that begin with what the wider one has.
#pragma once

#include <array>
#include <vector>

#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/programs.h"
#include "welkin/shading/fluence_layout.h"

namespace welkin::render {

class FluencePass {
 public:
  FluencePass();

  // Steps 0 to steps() - 1 in this order make the fluence of a volume that is swept; until exchange(), which
  // comes with the volume's own, fluence() is what was made before. After the first of a layout nothing is
  // compiled or allocated.
  void begin(const shading::LightVolumeLayout& volume);
  int steps() const;
  void step(int index, const gpu::Texture3D& lightVolume);
  void exchange() { front_ = 1 - front_; }

  // One channel, cascades one above another along z.
  const gpu::Texture3D& fluence() const { return fluences_[front_]; }

 private:
  float columnM(int cascade) const;  // side of its columns
  void cells(int cascade, bool sources, const gpu::Texture3D& lightVolume);
  void start(int cascade);
  void relax(int index, float columnM);
  void store(int cascade);

  gpu::FullscreenTriangle triangle_;
  ProgramVariants cellPrograms_{"pass/fluence_cells.frag"}, relaxPrograms_{"pass/fluence_relax.frag"};
  gpu::Program *depthsProgram_ = nullptr, *sourcesProgram_ = nullptr, *relaxProgram_ = nullptr;
  gpu::Program start_, store_;
  // Four cells to a texel.
  struct Packed {
    gpu::Texture3D cells;
    gpu::Framebuffer target;
  };
  Packed depths_, sources_;
  std::array<Packed, 3> steps_;
  std::size_t last_ = 0;
  gpu::Framebuffer slice_;
  std::array<gpu::Texture3D, 2> fluences_;
  std::size_t front_ = 0;
  std::vector<shading::LightVolumeLayout::Band> bands_;
  int slices_ = 0;
  bool towardsSun_ = true;
  shading::FluenceLayout layout_;
};

}  // namespace welkin::render
