// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_look.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"

namespace welkin::shading {

SheetMatter matterOf(const scene::Sheet& sheet, std::span<const float> pattern, std::uint64_t seed) {
  SheetMatter matter;
  matter.law = scene::condensationOf(sheet, pattern);
  matter.quantiles = field::PatternQuantiles(pattern);
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

SheetMatter matterAt(const scene::Sheet& sheet, const SheetMatter& described, double secondsAfter) {
  if (sheet.drift.drift.coverOktas == 0.0) return described;
  // The mean depth of the pattern's cloud under a law, by the table of its values.
  const auto meanDepth = [&](const field::Condensation& law) {
    constexpr int kColumns = 256;
    double sum = 0.0, count = 1e-9;
    for (int i = 0; i < kColumns; ++i) {
      const double excess = described.quantiles.above((i + 0.5) / kColumns) - law.threshold;
      if (excess <= 0.0) break;
      sum += law.k * excess;
      count += 1.0;
    }
    return std::clamp(sum / count, 0.05, 200.0);
  };
  SheetMatter now = described;
  now.law = scene::lawAt(sheet, described.law, described.quantiles, secondsAfter);
  now.typicalDepth = static_cast<float>(static_cast<double>(described.typicalDepth) * meanDepth(now.law) /
                                        meanDepth(described.law));
  return now;
}

SheetLook lookOf(const scene::Sheet& sheet, const SheetMatter& matter, double secondsAfter,
                 const glm::dvec3& eyeM, const glm::vec3& toLight, float pixelRad) {
  const bool volume = scene::hasVolume(sheet.surface);
  const glm::dvec2 moved = scene::windPathM(sheet, secondsAfter);
  const glm::dvec3 shift(eyeM.x - moved.x, eyeM.y - moved.y, volume ? -sheet.riseMps * secondsAfter : 0.0);
  SheetLook look;
  look.offset = glm::vec3(
      glm::fract(matter.origin + sheet.offset + shift / sheet.tileM));  // whole tiles make no difference
  look.perM = glm::vec3(1.0f, 1.0f, volume ? 1.0f : 0.0f) / static_cast<float>(sheet.tileM);
  look.wrap = sheet.surface == scene::SheetSurface::kHemisphere ? 1.0f : 0.0f;
  look.threshold = static_cast<float>(matter.law.threshold);
  look.steepness = static_cast<float>(std::min(matter.law.k, 1e4));
  look.bias = static_cast<float>(matter.law.bias);
  look.heightM = static_cast<float>(sheet.heightM);
  look.thicknessM = static_cast<float>(sheet.thicknessM);
  look.typicalDepth = matter.typicalDepth;
  look.tint = glm::vec3(sheet.colour);
  look.texelsPerPixel = pixelRad * static_cast<float>(static_cast<double>(sheet.texels) / sheet.tileM);

  const glm::vec2 level(toLight);
  const float n = glm::length(level);
  const glm::vec3 direction = n > 1e-4f ? glm::vec3(level / n, 0.0f) : glm::vec3(0.0f);
  if (sheet.tier == scene::SheetTier::kEmbossed) {
    // A slope by which the sheet gains its typical depth over a third of a cell is wholly sunny.
    const float texelsPerCell = static_cast<float>(sheet.texels) / static_cast<float>(scene::cellsOf(sheet));
    look.sunStep =
        direction * std::clamp(0.08f * look.steepness / look.typicalDepth * texelsPerCell, 1.0f, 60.0f);
  } else if (sheet.tier == scene::SheetTier::kLit) {
    // As far as the light runs through the sheet; low light comes from afar, but not from another cloud.
    const float slant = std::min(n / std::max(std::abs(toLight.z), 0.02f), 6.0f);
    look.sunStep = direction * (slant * look.thicknessM / static_cast<float>(sheet.tileM));
  }
  return look;
}

Image<float> withSlopes(const Image<float>& pattern) {
  const int w = pattern.width, h = pattern.height;
  Image<float> out(w, h, 4);
  parallelFor(static_cast<std::size_t>(h), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < w; ++x) {
        out.at(x, y, 0) = pattern.at(x, y);
        out.at(x, y, 1) = pattern.at((x + 1) % w, y) - pattern.at((x + w - 1) % w, y);
        out.at(x, y, 2) = pattern.at(x, (y + 1) % h) - pattern.at(x, (y + h - 1) % h);
      }
  });
  return out;
}

Volume<float> withSlopes(const Volume<float>& pattern) {
  const int nx = pattern.nx, ny = pattern.ny, nz = pattern.nz;
  Volume<float> out(nx, ny, nz, 4);
  parallelFor(static_cast<std::size_t>(nz), 2, [&](std::size_t begin, std::size_t end) {
    for (int z = static_cast<int>(begin); z < static_cast<int>(end); ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
          out.at(x, y, z, 0) = pattern.at(x, y, z);
          out.at(x, y, z, 1) = pattern.at((x + 1) % nx, y, z) - pattern.at((x + nx - 1) % nx, y, z);
          out.at(x, y, z, 2) = pattern.at(x, (y + 1) % ny, z) - pattern.at(x, (y + ny - 1) % ny, z);
          out.at(x, y, z, 3) = pattern.at(x, y, (z + 1) % nz) - pattern.at(x, y, (z + nz - 1) % nz);
        }
  });
  return out;
}

}  // namespace welkin::shading
