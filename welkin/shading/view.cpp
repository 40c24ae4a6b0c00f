// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/view.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "welkin/core/units.h"

namespace welkin::shading {

ViewParts partsOf(const View& view, int heightPx) {
  ViewParts parts;
  const glm::dmat3 cameraFromEnu(view.view);
  const glm::dmat3 enuFromCamera = glm::transpose(cameraFromEnu);
  parts.eyeM = -(enuFromCamera * glm::dvec3(view.view[3]));
  parts.enuFromCamera = glm::mat3(enuFromCamera);
  parts.clipFromEnu = glm::mat4(view.projection * glm::dmat4(cameraFromEnu));
  const glm::dmat4& p = view.projection;
  parts.rayScale = glm::vec4(1.0 / p[0][0], 1.0 / p[1][1], p[2][0] / p[0][0], p[2][1] / p[1][1]);
  parts.pixelRad = static_cast<float>(2.0 / (std::abs(p[1][1]) * heightPx));
  return parts;
}

View viewOf(const scene::SkyState& state, glm::dvec2 shiftPx) {
  const scene::Camera& camera = state.scene.camera;
  const double heading = radians(state.headingDeg), pitch = radians(camera.pitchDeg);
  const glm::dvec3 right(std::cos(heading), -std::sin(heading), 0.0);
  const glm::dvec3 forward(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                           std::sin(pitch));
  View view;
  view.view = glm::dmat4(glm::transpose(glm::dmat3(right, glm::cross(right, forward), -forward)));
  view.view[3] = view.view * glm::dvec4(0.0, 0.0, -camera.eyeM, 1.0);

  const double width = static_cast<double>(state.scene.output.width),
               height = static_cast<double>(state.scene.output.height);
  const double halfWidth = std::tan(0.5 * radians(camera.fovDeg)), halfHeight = halfWidth * height / width;
  constexpr double kNear = 1.0, kFar = 1e6;
  const glm::dvec2 shift = shiftPx * 2.0 * halfWidth / width;
  view.projection = glm::frustum(-halfWidth + shift.x, halfWidth + shift.x, -halfHeight - shift.y,
                                 halfHeight - shift.y, kNear, kFar);
  return view;
}

}  // namespace welkin::shading
