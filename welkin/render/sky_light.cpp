// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_light.h"

#include <glm/common.hpp>

#include "welkin/core/units.h"

namespace welkin::render {

std::array<float, 9> skyHarmonics(const glm::vec3& d) {
  return {0.282095f,
          0.488603f * d.y,
          0.488603f * d.z,
          0.488603f * d.x,
          1.092548f * d.x * d.y,
          1.092548f * d.y * d.z,
          0.315392f * (3.0f * d.z * d.z - 1.0f),
          1.092548f * d.x * d.z,
          0.546274f * (d.x * d.x - d.y * d.y)};
}

glm::vec3 SkyLight::illuminance(const glm::vec3& normal) const {
  constexpr auto kHalfSphere = static_cast<float>(kPi);
  // What the cosine over the half sphere leaves of each order.
  constexpr std::array<float, 3> kCosine = {kHalfSphere, 2.0f * kHalfSphere / 3.0f, kHalfSphere / 4.0f};
  const std::array<float, 9> y = skyHarmonics(normal);
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < y.size(); ++i)
    sum += kCosine[i == 0 ? 0 : (i < 4 ? 1 : 2)] * y[i] * luminance[i];
  return glm::max(sum, glm::vec3(0.0f));
}

}  // namespace welkin::render
