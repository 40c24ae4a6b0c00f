// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "welkin/core/units.h"
#include "welkin/reference/cloud_phases.h"
#include "welkin/reference/directions.h"

namespace welkin::reference {
namespace {

constexpr int kMostScatterings = 20000;

}  // namespace

CloudSource::CloudSource(const CloudMedium& medium, const glm::dvec3& toSun, const PhaseSampler& droplets,
                         const PhaseSampler& ice)
    : medium_(medium), toSun_(toSun), droplets_(droplets), ice_(ice), peak_(dropletPeak(droplets)) {}

// Light that comes along a chain of peaks to p and is scattered there by the rest of the phase function, or
// by the whole of it.
double CloudSource::byPeaks(const glm::dvec3& p, const glm::dvec3& view, bool isIce, double whole,
                            Random& random) const {
  const double share = peak_.integral();
  if (!(unit(random) < share)) return 0.0;
  PeakChain chain = drawPeaks(toSun_, peak_, random);
  const double c = glm::dot(view, chain.ways[chain.count - 1]);
  double lit = isIce ? ice_.density(c) : droplets_.density(c) - (1.0 - whole) * share * peak_.density(c);
  lit *= chain.weight / share;
  if (lit == 0.0) return 0.0;
  glm::dvec3 at = p;
  while (chain.count > 0) {
    const Ray ray{at, chain.ways[--chain.count]};
    const auto collision = medium_.collide(ray, CloudMedium::kToGround, random);
    if (!collision || scene::isFrozen(collision->matter)) return 0.0;
    at = ray.at(collision->t);
  }
  const Ray ray{at, toSun_};
  return lit * medium_.transmittance(ray, CloudMedium::kToGround, random);
}

CloudSourceSample CloudSource::trace(const glm::dvec3& p, const glm::dvec3& view, bool isIce,
                                     Random& random) const {
  CloudSourceSample sample;
  sample.sun = byPeaks(p, view, isIce, 1.0, random);
  Ray ray{p, turnedAnywhere(view, (isIce ? ice_ : droplets_).sampleVersine(1.0 - unit(random)), random)};
  for (int i = 0; i < kMostScatterings; ++i) {
    const auto collision = medium_.collide(ray, CloudMedium::kToGround, random);
    if (!collision) {
      (medium_.earth().toGround(ray, -1.0) >= 0.0 ? sample.toGround : sample.toSky) = true;
      break;
    }
    const glm::dvec3 at = ray.at(collision->t);
    const bool inIce = scene::isFrozen(collision->matter);
    const PhaseSampler& phase = inIce ? ice_ : droplets_;
    const double c = glm::dot(ray.way, toSun_);
    const double value = phase.density(c) - (inIce ? 0.0 : peak_.integral() * peak_.density(c));
    const Ray sunward{at, toSun_};
    sample.sun += value * medium_.transmittance(sunward, CloudMedium::kToGround, random);
    sample.sun += byPeaks(at, ray.way, inIce, 0.0, random);
    ray = {at, turnedAnywhere(ray.way, phase.sampleVersine(1.0 - unit(random)), random)};
  }
  return sample;
}

}  // namespace welkin::reference
