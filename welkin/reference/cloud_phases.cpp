// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_phases.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "welkin/core/units.h"
#include "welkin/optics/mie_phase.h"
#include "welkin/optics/phase.h"
#include "welkin/reference/directions.h"

namespace welkin::reference {
namespace {

constexpr double kPeakAbove = 0.3;  // 1/sr

}  // namespace

PhaseSampler dropletPhase(double diameterUm, DropletModel model) {
  if (model == DropletModel::kMie)
    return PhaseSampler::tabulated([=](double c) { return optics::phaseMieDroplet(c, diameterUm); });
  const optics::DropletPhase fit = optics::dropletPhase(static_cast<float>(diameterUm));
  return PhaseSampler::tabulated([=](double c) { return optics::phaseDroplet(static_cast<float>(c), fit); });
}

PhaseSampler snowPhase() {
  return PhaseSampler::tabulated([](double c) { return optics::phaseIce(static_cast<float>(c)); });
}

ColourPhase::ColourPhase(Image<float> table)
    : table_(std::move(table)), mean_(PhaseSampler::tabulated([this](double c) {
        const glm::dvec3 p = density(c);
        return (p.x + p.y + p.z) / 3.0;
      })) {}

glm::dvec3 ColourPhase::density(double cosine) const {
  const double at = std::acos(std::clamp(cosine, -1.0, 1.0)) / kPi * (table_.width - 1);
  const int i = std::min(static_cast<int>(at), table_.width - 2);
  glm::dvec3 p;
  for (int c = 0; c < 3; ++c) {
    const auto a = static_cast<double>(table_.at(i, 0, c)), b = static_cast<double>(table_.at(i + 1, 0, c));
    p[c] = a + (at - i) * (b - a);
  }
  return p;
}

PhaseSampler dropletPeak(const PhaseSampler& droplets) {
  return droplets.above(kPeakAbove);
}

PeakChain drawPeaks(const glm::dvec3& toLight, const PhaseSampler& peak, Random& random) {
  PeakChain chain;
  const double share = peak.integral();
  glm::dvec3 way = toLight;
  do {
    way = turnedAnywhere(way, peak.sampleVersine(1.0 - unit(random)), random);
    chain.ways[chain.count++] = way;
  } while (chain.count < PeakChain::kLongest && unit(random) < share);
  chain.weight = share / (chain.count < PeakChain::kLongest ? 1.0 - share : 1.0);
  return chain;
}

}  // namespace welkin::reference
