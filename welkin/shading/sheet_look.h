// SPDX-License-Identifier: Apache-2.0
// How a thin layer looks at one instant from one eye: the numbers of shaders/lib/sheet.glsl. Pure.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "welkin/core/image.h"
#include "welkin/field/condensation.h"
#include "welkin/field/pattern_quantiles.h"
#include "welkin/scene/sheet.h"

namespace welkin::shading {

struct SheetLook {
  // The members of `struct Sheet` in lib/sheet.glsl, with the same meanings.
  glm::vec3 offset{0.0f}, perM{0.0f};
  float wrap = 0.0f, threshold = 0.0f, steepness = 1.0f, bias = 1.0f, heightM = 0.0f, thicknessM = 1.0f,
        typicalDepth = 1.0f;
  glm::vec3 tint{1.0f};
  glm::vec3 sunStep{0.0f};      // uSunStep of pass/sheet.frag
  float texelsPerPixel = 1.0f;  // at 1 m
};

// What of it does not change with time: the law and the mean depth of its cloud.
struct SheetMatter {
  field::Condensation law;
  float typicalDepth = 1.0f;
  field::PatternQuantiles quantiles;  // of its pattern
  glm::dvec3 origin{0.0};             // of the pattern, tiles: each seed its own part
};
SheetMatter matterOf(const scene::Sheet& sheet, std::span<const float> pattern, std::uint64_t seed);
// The same at an instant, as the sheet's cover drifts.
SheetMatter matterAt(const scene::Sheet& sheet, const SheetMatter& described, double secondsAfter);

// secondsAfter: the scene's time; eyeM: in the world, east-north-up; toLight: unit;
// pixelRad: angle of a pixel.
SheetLook lookOf(const scene::Sheet& sheet, const SheetMatter& matter, double secondsAfter,
                 const glm::dvec3& eyeM, const glm::vec3& toLight, float pixelRad);

// A tiling pattern with its slopes beside it, for embossing: four channels, the value and the differences of
// the neighbours along x, y and z (0 in a picture).
Image<float> withSlopes(const Image<float>& pattern);
Volume<float> withSlopes(const Volume<float>& pattern);

}  // namespace welkin::shading
