// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/view.h"

#include <cmath>

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

}  // namespace welkin::shading
