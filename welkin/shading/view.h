// SPDX-License-Identifier: Apache-2.0
// Somebody's OpenGL camera, as passes need it. Pure.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "welkin/scene/sky_state.h"

namespace welkin::shading {

// What an engine has: OpenGL's conventions, the world being east-north-up metres from the place on the
// ground, z up.
struct View {
  glm::dmat4 view{1.0};        // from the world to the camera: x right, y up, z backwards; no scaling
  glm::dmat4 projection{1.0};  // to clip space; any perspective, off-axis ones too; its far plane is not used
};

// The same in parts.
struct ViewParts {
  glm::dvec3 eyeM{0.0};           // in the world; z: height above the ground
  glm::mat3 enuFromCamera{1.0f};  // directions
  glm::mat4 clipFromEnu{1.0f};    // positions relative to the eye, in east-north-up, to clip space
  glm::vec4 rayScale{1.0f};       // xy * clip.xy + zw: x and y of the ray at depth 1, in the camera
  float pixelRad = 0.0f;          // angle of a pixel in the middle
};
ViewParts partsOf(const View& view, int heightPx);

// The camera of a scene, in a perspective picture of its size. shiftPx moves the picture's samples within
// their pixels, x right, y down.
View viewOf(const scene::SkyState& state, glm::dvec2 shiftPx = glm::dvec2(0.0));

}  // namespace welkin::shading
