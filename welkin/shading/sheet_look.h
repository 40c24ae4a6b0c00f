// SPDX-License-Identifier: Apache-2.0
// How a thin layer is drawn at one instant, from one eye: the numbers of shaders/lib/sheet.glsl. Pure.
#pragma once

#include <glm/vec3.hpp>

#include "welkin/scene/sheet.h"
#include "welkin/scene/sky_state.h"

namespace welkin::shading {

struct SheetLook {
  // The members of `struct Sheet` in lib/sheet.glsl, with the same meanings.
  glm::vec3 offset{0.0f}, perM{0.0f};
  float threshold = 0.0f, steepness = 1.0f, bias = 1.0f, heightM = 0.0f, thicknessM = 1.0f,
        typicalDepth = 1.0f;
  scene::SheetTier tier = scene::SheetTier::kLit;
  glm::vec3 sunStep{0.0f};  // towards the light in the pattern
  float emboss = 1.0f;
};

}  // namespace welkin::shading
