// SPDX-License-Identifier: Apache-2.0
// How a thin layer looks at one instant from one eye: the numbers of shaders/lib/sheet.glsl. Pure.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "welkin/field/condensation.h"
#include "welkin/scene/sheet.h"

namespace welkin::shading {

struct SheetLook {
  // The members of `struct Sheet` in lib/sheet.glsl, with the same meanings.
  glm::vec3 offset{0.0f}, perM{0.0f};
  float threshold = 0.0f, steepness = 1.0f, bias = 1.0f, heightM = 0.0f, thicknessM = 1.0f,
        typicalDepth = 1.0f;
  glm::vec3 sunStep{0.0f};  // towards the light in the pattern
  float emboss = 1.0f;      // slope that is wholly sunny or shady
};

// What of it does not change with time: the law and the mean depth of its cloud.
struct SheetMatter {
  field::Condensation law;
  float typicalDepth = 1.0f;
  glm::dvec3 origin{0.0};  // of the pattern, tiles: each seed its own part
};
SheetMatter matterOf(const scene::Sheet& sheet, std::span<const float> pattern, std::uint64_t seed);

// secondsAfter: the scene's time; eyeM: in the world, east-north-up; toLight: unit.
SheetLook lookOf(const scene::Sheet& sheet, const SheetMatter& matter, double secondsAfter,
                 const glm::dvec3& eyeM, const glm::vec3& toLight);

}  // namespace welkin::shading
