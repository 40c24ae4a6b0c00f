// SPDX-License-Identifier: Apache-2.0
// Light that a point in a cloud scatters on, by Monte Carlo: the truth that the closed forms of
// shaders/lib/cloud_light.glsl are fitted to (tools/fit_cloud_light.py). Clouds alone: no air, a black ground
// and a sun that is a point.
#pragma once

#include <glm/vec3.hpp>

#include "welkin/core/random.h"
#include "welkin/reference/cloud_medium.h"
#include "welkin/reference/phase_sampler.h"

namespace welkin::reference {

// Of one path.
struct CloudSourceSample {
  double sun = 0.0;    // radiance a unit of extinction, for a sun of unit illuminance, 1/sr; without light
                       // that has been scattered once only
  bool toSky = false;  // the path leaves upwards: the mean is the share of uniform light from above
  bool toGround = false;
};

class CloudSource {
 public:
  // medium: outlives this. toSun: unit, above the horizon. ice, droplets: their phase functions.
  CloudSource(const CloudMedium& medium, const glm::dvec3& toSun, const PhaseSampler& droplets,
              const PhaseSampler& ice);

  // What is scattered at p by droplets or by ice and arrives at an eye that looks along `view`, unit.
  CloudSourceSample trace(const glm::dvec3& p, const glm::dvec3& view, bool isIce, Random& random) const;

 private:
  double byPeaks(const glm::dvec3& p, const glm::dvec3& view, bool isIce, double whole, Random& random) const;

  const CloudMedium& medium_;
  glm::dvec3 toSun_;
  const PhaseSampler &droplets_, &ice_;
  PhaseSampler peak_;
};

}  // namespace welkin::reference
