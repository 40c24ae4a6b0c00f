// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/view_cone.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace welkin::render {

ViewCone coneOf(const shading::ViewParts& view) {
  const auto ray = [&](float x, float y) {
    const glm::vec3 r(view.rayScale.x * x + view.rayScale.z, view.rayScale.y * y + view.rayScale.w, -1.0f);
    return glm::normalize(glm::dvec3(view.enuFromCamera * r));
  };
  ViewCone cone{ray(0.0f, 0.0f), 0.0};
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      cone.halfAngle =
          std::max(cone.halfAngle, std::acos(std::clamp(glm::dot(cone.axis, ray(x, y)), -1.0, 1.0)));
  return cone;
}

bool mayBeSeen(const ViewCone& cone, const glm::dvec3& centreM, double radiusM) {
  const double distance = glm::length(centreM);
  if (distance <= radiusM) return true;
  const double angle = std::acos(std::clamp(glm::dot(cone.axis, centreM) / distance, -1.0, 1.0));
  return angle <= cone.halfAngle + std::asin(radiusM / distance);
}

}  // namespace welkin::render
