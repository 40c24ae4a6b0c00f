// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/light.h"

#include "welkin/core/colour.h"

namespace welkin::sky {
namespace {

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

Light sunLight(const Ephemeris& e) {
  return {glm::vec3(e.sun.direction), static_cast<float>(e.sunIlluminanceLux) * sunlightColour()};
}

Light moonLight(const Ephemeris& e) {
  return {glm::vec3(e.moon.direction), static_cast<float>(e.moonIlluminanceLux) * moonlightColour()};
}

}  // namespace welkin::sky
