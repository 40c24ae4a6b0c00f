// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/light.h"

#include <cmath>

#include "welkin/core/colour.h"
#include "welkin/core/glsl.h"

namespace welkin::sky {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/moon.glsl"
}  // namespace shared

// The triple scaled to photometric weight 1.
glm::vec3 unitLuminance(glm::vec3 c) {
  return c / luminanceOf(&c.x);
}

}  // namespace

glm::vec3 sunlightColour() {
  return unitLuminance({1.0894f, 0.9776f, 0.9582f});
}

glm::vec3 moonlightColour() {
  return unitLuminance(sunlightColour() * glm::vec3(1.157f, 0.990f, 0.799f));
}

double moonDiscMean(double phaseAngleRad) {
  const glm::vec2 phase = shared::moonPhase(static_cast<float>(std::cos(phaseAngleRad)));
  return static_cast<double>(shared::moonMean(phase)) + static_cast<double>(shared::kEarthshine);
}

Light sunLight(const Ephemeris& e) {
  return {glm::vec3(e.sun.direction), static_cast<float>(e.sunIlluminanceLux) * sunlightColour(),
          e.solarEclipse.shadow};
}

Light moonLight(const Ephemeris& e) {
  const glm::vec3 full = fullMoonlight(e);
  return {glm::vec3(e.moon.direction), e.lunarEclipse.any() ? full * e.lunarEclipse.share : full};
}

glm::vec3 fullMoonlight(const Ephemeris& e) {
  if (!e.lunarEclipse.any()) return static_cast<float>(e.moonIlluminanceLux) * moonlightColour();
  const glm::vec3 left = moonlightColour() * e.lunarEclipse.share;
  return static_cast<float>(e.moonIlluminanceLux) / luminanceOf(&left.x) * moonlightColour();
}

}  // namespace welkin::sky
