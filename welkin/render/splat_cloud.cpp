// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/splat_cloud.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace welkin::render {

glm::dmat3 axesOf(const glm::dvec3& toLight) {
  const glm::dvec3 away = -glm::normalize(toLight);
  const glm::dvec3 other = std::abs(away.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 across = glm::normalize(glm::cross(away, other));
  return {across, glm::cross(across, away), away};
}

}  // namespace welkin::render
