// SPDX-License-Identifier: Apache-2.0
// What happens to a path from the eye where it meets something: a scattering in air or cloud, a reflection of
// the ground.
#pragma once

#include <glm/vec3.hpp>

#include "welkin/reference/traced_sky.h"

namespace welkin::reference {

// A path on its way to its next event. The throughput is what of the light that comes along reaches the eye.
struct SkyPath {
  Ray ray;
  glm::dvec3 throughput{1.0};
  bool first = false;  // straight from the eye
};

class SkyEvent {
 public:
  // Air at p, scattering as `m` does.
  static SkyEvent inAir(const TracedSky& sky, const SkyPath& path, const glm::dvec3& p, const Air::Medium& m);
  // phase: one of the sky's. Of droplets, events other than the first leave the peak to the event before.
  static SkyEvent inCloud(const TracedSky& sky, const SkyPath& path, const glm::dvec3& p,
                          const PhaseSampler& phase);
  static SkyEvent onGround(const TracedSky& sky, const glm::dvec3& p);

  const glm::dvec3& place() const { return p_; }
  // The share of light from w that leaves on the path, 1/sr.
  glm::dvec3 value(const glm::dvec3& w) const;
  // How often light is looked for that comes by way of clouds.
  double chain() const;
  // The path from here on, against the way of light; its throughput changes with the colour of what scatters.
  void leave(SkyPath& path, Random& random) const;

 private:
  enum class Kind { kAir, kPhase, kColours, kGround };
  SkyEvent(const TracedSky& sky, Kind kind, const glm::dvec3& p) : sky_(&sky), kind_(kind), p_(p) {}

  const TracedSky* sky_;
  Kind kind_;
  glm::dvec3 p_, from_{0.0};                 // from_: the path's way to here, or the ground's normal
  glm::dvec3 rayleigh_{0.0}, aerosol_{0.0};  // of air: shares of what scatters
  const PhaseSampler* phase_ = nullptr;
  const ColourPhase* colours_ = nullptr;
  double peak_ = 0.0;  // share of the peak that is left out
};

}  // namespace welkin::reference
