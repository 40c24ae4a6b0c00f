// SPDX-License-Identifier: Apache-2.0
// The camera of a sky as shaders/lib/projection.glsl has it: which direction a place in the picture shows.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "welkin/scene/sky_state.h"

namespace welkin::scene {

// The fields of the struct of that name there.
struct Projector {
  int kind = 0;
  glm::vec2 sizePx{1.0f};
  float halfWidthTan = 1.0f;
  glm::mat3 enuFromCamera{1.0f};
};
Projector projectorOf(const SkyState& state);

// Direction and size of a place in the picture, pixels from the top left corner; false outside the picture's
// circle.
bool directionAt(const Projector& projector, glm::vec2 px, glm::vec3& direction, float& pixelRad);
// Angle of a pixel in the middle: there are no larger ones.
float middlePixelRad(const Projector& projector);

}  // namespace welkin::scene
