// SPDX-License-Identifier: Apache-2.0
// Sun and moon as lights of a traced sky: discs to aim at and to see.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "welkin/reference/air.h"
#include "welkin/scene/sky_state.h"

namespace welkin::reference {

// A direction in a light's disc, drawn in proportion to its luminance, so that the light it stands for is all
// of the light.
struct LightSample {
  glm::dvec3 direction{0.0};
  int disc = -1;        // none: -1
  double weight = 0.0;  // one over the chance of the choice
};

class SkyLights {
 public:
  SkyLights(const scene::SkyState& state, const Air& air, const Sphere& earth);

  // One of the lights, the likelier the more of it may reach p.
  LightSample sample(const glm::dvec3& p, Random& random) const;
  // The ground is in the way of it at p.
  bool isBelow(const LightSample& light, const glm::dvec3& p) const {
    return light.disc < 0 || earth_->toGround({p, light.direction}, -1.0) >= 0.0;
  }
  // What it brings to p through the air and past the ground, times its weight: lux on a plane facing it.
  glm::dvec3 illuminance(const LightSample& light, const glm::dvec3& p) const;
  // Luminance of the discs above the air.
  glm::dvec3 discs(const glm::dvec3& direction) const;

 private:
  struct Disc {
    bool isSun;
    glm::dvec3 direction, illuminance;  // the sun's not eclipsed
    glm::dvec3 east, north;             // unit, across the direction and each other
    double radius;                      // rad
    glm::dvec3 luminance;               // of what is drawn on the disc shares, not eclipsed, cd/m2
    sky::MoonShadow shadow;             // on the air about the eye
    AirToLight through;
  };
  const Sphere* earth_;
  glm::dvec3 sunDirection_{0.0}, moonDirection_{0.0}, eye_{0.0};
  double moonRadius_ = 0.0;  // rad
  sky::LunarEclipse lunarEclipse_;
  std::vector<Disc> discs_;  // that give light, as in state.lights
};

}  // namespace welkin::reference
