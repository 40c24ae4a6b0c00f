// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_look.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "welkin/core/random.h"
#include "welkin/core/units.h"

namespace welkin::shading {

SheetMatter matterOf(const scene::Sheet& sheet, std::span<const float> pattern, std::uint64_t seed) {
  SheetMatter matter;
  matter.law = scene::condensationOf(sheet, pattern);
  double sum = 0.0, count = 1e-9;
  for (const float p : pattern) {
    const double depth = matter.law.k * std::max(p - matter.law.threshold, 0.0);
    sum += depth;
    count += depth > 0.0;
  }
  matter.typicalDepth = static_cast<float>(std::clamp(sum / count, 0.05, 200.0));
  Random random(seed);
  matter.origin = {random.uniform(), random.uniform(), random.uniform()};
  return matter;
}

SheetLook lookOf(const scene::Sheet& sheet, const SheetMatter& matter, double secondsAfter,
                 const glm::dvec3& eyeM, const glm::vec3& toLight) {
  const bool volume = sheet.surface == scene::SheetSurface::kDome;
  const double towards = radians(sheet.windFromDeg + 180.0), moved = sheet.windSpeedMps * secondsAfter;
  const glm::dvec3 shift(eyeM.x - moved * std::sin(towards), eyeM.y - moved * std::cos(towards),
                         volume ? -sheet.riseMps * secondsAfter : 0.0);
  SheetLook look;
  look.offset = glm::vec3(glm::fract(matter.origin + shift / sheet.tileM));  // whole tiles make no difference
  look.perM = glm::vec3(1.0f, 1.0f, volume ? 1.0f : 0.0f) / static_cast<float>(sheet.tileM);
  look.threshold = static_cast<float>(matter.law.threshold);
  look.steepness = static_cast<float>(std::min(matter.law.k, 1e4));
  look.bias = static_cast<float>(matter.law.bias);
  look.heightM = static_cast<float>(sheet.heightM);
  look.thicknessM = static_cast<float>(sheet.thicknessM);
  look.typicalDepth = matter.typicalDepth;

  const glm::vec2 level(toLight);
  const float n = glm::length(level);
  const glm::vec3 direction = n > 1e-4f ? glm::vec3(level / n, 0.0f) : glm::vec3(0.0f);
  if (sheet.tier == scene::SheetTier::kEmbossed) {
    // Two texels on; a slope of a typical depth over that way is wholly sunny.
    look.sunStep = direction * (2.0f / static_cast<float>(sheet.texels));
    look.emboss = 0.25f * look.steepness / look.typicalDepth * static_cast<float>(sheet.texels) /
                  (2.0f * static_cast<float>(sheet.frequency));
    look.emboss = std::clamp(look.emboss, 1.0f, 60.0f);
  } else if (sheet.tier == scene::SheetTier::kLit) {
    // As far as the light runs through the sheet; low light comes from afar, but not from another cloud.
    const float slant = std::min(n / std::max(std::abs(toLight.z), 0.02f), 6.0f);
    look.sunStep = direction * (slant * look.thicknessM / static_cast<float>(sheet.tileM));
  }
  return look;
}

}  // namespace welkin::shading
