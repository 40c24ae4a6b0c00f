// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/projector.h"

#include <cmath>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"

namespace welkin::scene {
namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/projection.glsl"
}  // namespace shared

Projector projectorOf(const SkyState& state) {
  const Camera& camera = state.scene.camera;
  const double heading = radians(state.headingDeg);
  const bool perspective = camera.projection == Projection::kPerspective;
  const double pitch = perspective ? radians(camera.pitchDeg) : 0.0;
  const glm::dvec3 right(std::cos(heading), -std::sin(heading), 0.0);
  const glm::dvec3 forward(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                           std::sin(pitch));
  const glm::dvec3 up(-std::sin(heading) * std::sin(pitch), -std::cos(heading) * std::sin(pitch),
                      std::cos(pitch));
  return {static_cast<int>(camera.projection),
          {static_cast<float>(state.scene.output.width), static_cast<float>(state.scene.output.height)},
          static_cast<float>(std::tan(0.5 * radians(camera.fovDeg))),
          glm::mat3(glm::dmat3(right, forward, up))};
}

bool directionAt(const Projector& p, glm::vec2 px, glm::vec3& direction, float& pixelRad) {
  const shared::Projector projector{p.kind, p.sizePx, p.halfWidthTan, p.enuFromCamera};
  return shared::projectorDirection(projector, px, direction, pixelRad);
}

float middlePixelRad(const Projector& projector) {
  glm::vec3 direction(0.0f);
  float pixelRad = 0.0f;
  directionAt(projector, 0.5f * projector.sizePx, direction, pixelRad);
  return pixelRad;
}

}  // namespace welkin::scene
