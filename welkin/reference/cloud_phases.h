// SPDX-License-Identifier: Apache-2.0
// How clouds scatter, as samplers; and the forward peak of droplets, which is looked for from the light's
// side.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "welkin/core/image.h"
#include "welkin/core/random.h"
#include "welkin/optics/phase.h"
#include "welkin/reference/phase_sampler.h"

namespace welkin::reference {

using optics::DropletModel;  // Mie's: mean of three wavelengths, without colours

PhaseSampler dropletPhase(double diameterUm, DropletModel model);
PhaseSampler snowPhase();  // phaseIce() of optics/phase.h

// Rain and ice scatter colours by different angles. Directions are drawn by the mean of the three.
class ColourPhase {
 public:
  // table: as those of optics/rain_phase.h and optics/ice_phase.h.
  explicit ColourPhase(Image<float> table);
  const PhaseSampler& mean() const { return mean_; }
  // 1/sr, of red, green and blue: that of the table.
  glm::dvec3 density(double cosine) const;

 private:
  Image<float> table_;
  PhaseSampler mean_;
};

// The part of the droplets' phase function that is large, by itself; its integral is its share of all they
// scatter. What it leaves is nowhere above 0.3 / sr.
PhaseSampler dropletPeak(const PhaseSampler& droplets);

// Scatterings by the peak one after the other, drawn from the light's side; sky_paths.cpp says what for. Of
// `count` with the chance of s^(count - 1) (1 - s), where s is the peak's integral.
struct PeakChain {
  static constexpr std::size_t kLongest = 24;
  std::array<glm::dvec3, kLongest> ways;  // towards the light, the last scattering's first
  std::size_t count = 0;                  // at least 1
  double weight = 0.0;  // of light along it: what peaks scatter over the chance of the chain
};
PeakChain drawPeaks(const glm::dvec3& toLight, const PhaseSampler& peak, Random& random);

}  // namespace welkin::reference
