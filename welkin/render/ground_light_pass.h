// SPDX-License-Identifier: Apache-2.0
// Where the ground around the eye has more or less light than on average, by the depths of a light volume
// (shaders/lib/ground_light.glsl and ground_light_sums.glsl).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

class GroundLightPass {
 public:
  GroundLightPass();

  // Steps 0 to steps() - 1 in this order make the shares of a volume that is swept; until exchange(), which
  // comes with the volume's own, shares() is what was made before. After the first of a layout nothing is
  // compiled or allocated.
  void begin(const shading::LightVolumeLayout& volume);
  int steps() const { return steps_; }
  void step(int index, const gpu::Texture3D& lightVolume);
  void exchange() { front_ = 1 - front_; }

  const gpu::Texture2D& shares() const { return shares_[front_].texture; }

 private:
  struct Drawn {
    gpu::Texture2D texture;
    gpu::Framebuffer target;
    Drawn(int side, gpu::Format format);
  };

  gpu::FullscreenTriangle triangle_;
  gpu::Program rowsProgram_, meanProgram_, columnsProgram_;
  Drawn rows_, mean_;
  std::array<Drawn, 2> shares_;
  std::size_t front_ = 0;
  int steps_ = 0;
  std::vector<shading::LightVolumeLayout::Band> bands_;  // whose uniforms are set
};

}  // namespace welkin::render
