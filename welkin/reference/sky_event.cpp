// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/sky_event.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "welkin/core/units.h"
#include "welkin/reference/directions.h"

namespace welkin::reference {
namespace {

// How often air and ground look for light by way of clouds.
constexpr double kChainOfOthers = 0.25;

double sum(const glm::dvec3& v) {
  return v.x + v.y + v.z;
}

}  // namespace

SkyEvent SkyEvent::inAir(const TracedSky& sky, const SkyPath& path, const glm::dvec3& p,
                         const Air::Medium& m) {
  SkyEvent e(sky, Kind::kAir, p);
  const glm::dvec3 scattering = glm::max(m.rayleigh + m.aerosol, glm::dvec3(1e-300));
  e.from_ = path.ray.way;
  e.rayleigh_ = m.rayleigh / scattering;
  e.aerosol_ = m.aerosol / scattering;
  return e;
}

SkyEvent SkyEvent::inCloud(const TracedSky& sky, const SkyPath& path, const glm::dvec3& p,
                           const PhaseSampler& phase) {
  SkyEvent e(sky, Kind::kPhase, p);
  e.from_ = path.ray.way;
  e.phase_ = &phase;
  if (&phase == &sky.rain.mean() || &phase == &sky.ice.mean()) {
    e.kind_ = Kind::kColours;
    e.colours_ = &phase == &sky.rain.mean() ? &sky.rain : &sky.ice;
  } else if (&phase == &sky.droplets && !path.first) {
    // The first event of all has none before it that would find its peak.
    e.peak_ = sky.peak.integral();
  }
  return e;
}

SkyEvent SkyEvent::onGround(const TracedSky& sky, const glm::dvec3& p) {
  SkyEvent e(sky, Kind::kGround, p);
  e.from_ = sky.earth.up(p);
  return e;
}

glm::dvec3 SkyEvent::value(const glm::dvec3& w) const {
  const double c = glm::dot(from_, w);
  switch (kind_) {
    case Kind::kAir:
      return rayleigh_ * sky_->air.phaseRayleigh(c) + aerosol_ * sky_->air.phaseAerosol(c);
    case Kind::kColours:
      return colours_->density(c);
    case Kind::kGround:
      return glm::dvec3(std::max(c, 0.0) / kPi);
    case Kind::kPhase:
      break;
  }
  if (peak_ <= 0.0) return glm::dvec3(phase_->density(c));
  const std::size_t step = phase_->stepAt(1.0 - c);  // of the peak as well, which is cut off them
  return glm::dvec3(phase_->densityIn(step) - peak_ * sky_->peak.densityIn(step));
}

double SkyEvent::chain() const {
  return phase_ ? sky_->peak.integral() : kChainOfOthers;
}

void SkyEvent::leave(SkyPath& path, Random& random) const {
  path.first = false;
  if (kind_ == Kind::kGround) {
    path.ray = {p_, lambertDirection(from_, random)};
    return;
  }
  double versine = 0.0;
  if (kind_ == Kind::kAir) {
    const Air& air = sky_->air;
    const double share = sum(path.throughput * aerosol_) / sum(path.throughput);
    const double c = unit(random) < share ? air.sampleAerosol(random) : air.sampleRayleigh(random);
    const double pr = air.phaseRayleigh(c), pa = air.phaseAerosol(c);
    path.throughput *= (rayleigh_ * pr + aerosol_ * pa) / ((1.0 - share) * pr + share * pa);
    versine = 1.0 - c;
  } else {
    versine = phase_->sampleVersine(1.0 - unit(random));
    if (colours_) path.throughput *= colours_->density(1.0 - versine) / phase_->density(1.0 - versine);
  }
  path.ray = {p_, turnedAnywhere(from_, versine, random)};
}

}  // namespace welkin::reference
