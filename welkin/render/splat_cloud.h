// SPDX-License-Identifier: Apache-2.0
// A cloud of metaballs as it is drawn, and the frame of a direction of light.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "welkin/field/metaballs.h"
#include "welkin/scene/metaballs.h"

namespace welkin::render {

using SplatPhase = scene::MetaballPhase;

// One cloud: in the view's world, densities being extinctions, 1/m; negative ones take away. Balls of radius
// 0 or density 0 are left out.
struct SplatCloud {
  std::span<const field::Metaball> balls;
  SplatPhase phase = SplatPhase::kDroplets;
  float albedo = 1.0f;  // 0.9 in P. Man
  // Where two levels of detail fade into one another, the balls of the coarser come first: so many, and their
  // share. What is found for a cloud's extent then fades with them.
  std::size_t coarse = ~std::size_t{0};
  float coarseShare = 1.0f;
  // As what it shades others, where fewer balls will do.
  std::span<const field::Metaball> shade{};
  std::span<const field::Metaball> shades() const { return shade.empty() ? balls : shade; }
  // Of it that is a picture (render/splat_pictures.h), and not balls.
  scene::CloudBalls::Far far{};
};

// Whether a ball is drawn at all.
inline bool drawn(const field::Metaball& b) {
  return b.density != 0.0 && b.radiusM > 0.0;
}

// Across, upward and away from the light.
glm::dmat3 axesOf(const glm::dvec3& toLight);

}  // namespace welkin::render
