// SPDX-License-Identifier: Apache-2.0
// What lights clouds of metaballs: the key light, the other one of sun and moon where it is seen beside it,
// and the sky, which has a bright side. Pure. Sheets and volumes have the key light alone.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "welkin/scene/sky_state.h"

namespace welkin::shading {

struct SplatLights {
  glm::vec3 toKey{0.0f, 0.0f, 1.0f};
  std::optional<glm::vec3> toSecond;
  glm::vec3 toGlow{0.0f, 1.0f, 0.0f};  // level: the side that more light comes from, of sky and air below it
};

// Whether lights[1] is seen on clouds: at some height its illuminance, facing it, is more than kSeenShare of
// that of the first and the sky together. In daylight the moon is not; it is from four degrees of dusk on.
constexpr float kSeenShare = 0.005f;
bool secondLightSeen(const scene::SkyState& state);

SplatLights splatLights(const scene::SkyState& state);

}  // namespace welkin::shading
