// SPDX-License-Identifier: Apache-2.0
// Where the light of the sun goes that a lens does not send where it should: a glow about the sun, and
// ghosts, the light that surfaces of the lens mirror to and fro, on the line from the sun through the optical
// axis. Pure.
//
// Positions are those of K. Pallister, "Generating Procedural Clouds Using 3D Hardware" and its kind: shares
// of the sun's offset from the axis. Light is absolute: a sprite spreads its share w of the sun's illuminance
// E over its solid angle,
//
//   L = strength w E / (pi a b),
//
// a and b being its half axes as tangents of angles in the middle of the picture, where the solid angle is pi
// a b.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "welkin/scene/sky_state.h"
#include "welkin/shading/view.h"

namespace welkin::shading {

// All in clip space after the division: the picture is [-1, 1], x right, y up.
struct FlareSprite {
  glm::vec2 centre{0.0f}, halfSize{1.0f};
  glm::vec3 light{0.0f};  // mean luminance over the sprite for a strength of 1, cd/m2
  float hollow = 0.0f;    // a ghost's: 0 a disc, 1 a ring; below 0: it is the glow
};

struct LensFlare {
  static constexpr std::array<float, 5> kGhostsAt = {0.5f, 0.333f, -0.05f, -0.25f, -0.75f};
  static constexpr std::size_t kSprites = kGhostsAt.size() + 1;

  float shown = 0.0f;  // share of the sun's disc within the picture, [0, 1]; 0: there is no flare
  glm::vec2 sunAt{0.0f}, sunHalfSize{0.0f};
  std::array<FlareSprite, kSprites> sprites;  // the glow first, then as kGhostsAt
};

// The illuminance of the sun that reaches an eye through clear air, facing it, lux. None from below the
// horizon.
glm::vec3 sunlightAt(const scene::SkyState& state, double eyeM);

// toSun: unit, east-north-up; sunRadiusRad: angular; illuminance: lux, Rec. 709.
LensFlare lensFlareOf(const ViewParts& view, const glm::vec3& toSun, float sunRadiusRad,
                      const glm::vec3& illuminance);

}  // namespace welkin::shading
