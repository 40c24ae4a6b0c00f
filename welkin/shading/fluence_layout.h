// SPDX-License-Identifier: Apache-2.0
// Where the cells of the fluence lie (shaders/lib/fluence.glsl) among the slices of the light volume.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "welkin/shading/uniforms.h"

namespace welkin::shading {

struct FluenceLayout {
  int columns = 0;                       // a side, of each cascade: one for two of the light volume
  static constexpr int kMostCells = 16;  // on one another: four textures of four channels
  std::vector<glm::vec4> cells;  // from the ground up: slices at the lower and the upper edge, depth m, 0
  // Of each band of the light volume: its first cell, what follows its last one; the least and the greatest
  // coordinate at which it is looked up.
  std::vector<glm::vec4> bands;
};

// Bands that do not touch have a cell of air between them, the widest gaps first where there is not room for
// all.
FluenceLayout fluenceLayout(const LightVolumeLayout& volume);
Uniforms fluenceUniforms(const FluenceLayout& layout);

}  // namespace welkin::shading
