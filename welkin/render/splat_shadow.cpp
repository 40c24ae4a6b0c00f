// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/splat_shadow.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace welkin::render {
namespace {

constexpr int kShadowPx = 1024;

}  // namespace

void SplatShadow::draw(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM, const glm::vec3& toLight,
                       gpu::Program& depth) {
  halfM_ = 0.0f;
  if (toLight.z <= 0.0f) return;
  const glm::dmat3 axes = axesOf(toLight);
  const glm::dvec3 underEye(eyeM.x, eyeM.y, 0.0);
  const auto near = [&](const field::Metaball& b) {
    return drawn(b) && glm::length(b.centreM - underEye) - b.radiusM < kReachM;
  };
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const SplatCloud& cloud : clouds)
    for (const field::Metaball& b : cloud.balls) {
      if (!near(b)) continue;
      const glm::dvec2 at((b.centreM - underEye) * axes);
      low = glm::min(low, at - b.radiusM);
      high = glm::max(high, at + b.radiusM);
    }
  if (!(low.x < high.x)) return;
  if (shadow_.width() == 0) {
    shadow_ = gpu::Texture2D(kShadowPx, kShadowPx, {.format = gpu::Format::kR32F});
    toShadow_.emplace(shadow_);
  }
  const glm::dvec2 middle = 0.5 * (low + high);
  const double half = 0.5 * std::max(high.x - low.x, high.y - low.y) * kShadowPx / (kShadowPx - 4.0);
  const double texelM = 2.0 * half / kShadowPx;
  values_.clear();
  for (const SplatCloud& cloud : clouds)
    for (const field::Metaball& b : cloud.balls) {
      if (!near(b)) continue;
      const glm::dvec2 at = (glm::dvec2((b.centreM - underEye) * axes) - middle) / half;
      const double radiusM = std::max(b.radiusM, texelM), share = b.radiusM / radiusM;
      values_.insert(
          values_.end(),
          {static_cast<float>((0.5 + 0.5 * at.x) * kShadowPx),
           static_cast<float>((0.5 + 0.5 * at.y) * kShadowPx), static_cast<float>(radiusM / texelM),
           static_cast<float>(b.density * share * share * share * radiusM), 1.0f, 0.0f, 0.0f, 0.0f});
    }
  balls_.upload(values_);
  depth.set("uPerTexel", glm::vec2(1.0f / kShadowPx));
  toShadow_->clear();
  balls_.draw(depth, *toShadow_, {.blend = gpu::Blend::kAdd});
  axes_ = {glm::vec4(axes[0], middle.x), glm::vec4(axes[1], middle.y)};
  halfM_ = static_cast<float>(half);
}

void SplatShadow::set(gpu::Program& program) const {
  program.set("uSplatShadowAxes", std::span<const glm::vec4>(axes_));
  program.set("uSplatShadowHalfM", halfM_);
  if (shadow_.width() > 0) program.bind("uSplatShadow", shadow_);
}

}  // namespace welkin::render
