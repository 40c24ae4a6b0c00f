// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/splat_lights.h"

#include <glm/geometric.hpp>

#include "welkin/core/colour.h"
#include "welkin/core/units.h"

namespace welkin::shading {

bool secondLightSeen(const scene::SkyState& state) {
  const auto lux = [](const glm::vec3& light) { return luminanceOf(&light.x); };
  for (const double heightM : {500.0, 2000.0, 5000.0, 10000.0}) {
    const auto arriving = [&](const sky::Light& light) {
      return lux(light.illuminance *
                 state.atmosphere->transmittanceToSpace(state.scene.place.altitudeM + heightM,
                                                        static_cast<double>(light.direction.z)));
    };
    const auto high = static_cast<float>(heightM / scene::ClearSkyKey::kHighM);
    const float sky =
        static_cast<float>(kPi) * lux((1.0f - high) * state.ambient.skyLow + high * state.ambient.skyHigh);
    if (arriving(state.lights[1]) > kSeenShare * (arriving(state.lights[0]) + sky)) return true;
  }
  return false;
}

SplatLights splatLights(const scene::SkyState& state) {
  SplatLights lights;
  lights.toKey = state.lights[0].direction;
  if (secondLightSeen(state)) lights.toSecond = state.lights[1].direction;
  const sky::LightMoments around = state.ambient.aboveLow + state.ambient.below;
  const glm::vec3 side(luminanceOf(&around.along[0].x), luminanceOf(&around.along[1].x), 0.0f);
  if (glm::length(side) > 1e-4f * luminanceOf(&around.total.x)) lights.toGlow = glm::normalize(side);
  return lights;
}

}  // namespace welkin::shading
