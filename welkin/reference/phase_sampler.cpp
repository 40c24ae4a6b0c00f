// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/phase_sampler.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "welkin/core/units.h"

namespace welkin::reference {
namespace {

constexpr int kSteps = 2048;
constexpr int kGuides = 4096;

// Angles crowd towards 0, where droplets have their peak.
double edgeCosine(int i) {
  const double x = 1.0 - static_cast<double>(i) / kSteps;
  return std::cos(kPi * x * x);
}

// A number that falls from 1 to 0 as a cosine rises, about as evenly as the steps do: the root of the half
// angle's sine.
double placeOf(double cosine) {
  return std::sqrt(std::sqrt(std::max(0.5 - 0.5 * cosine, 0.0)));
}

}  // namespace

PhaseSampler PhaseSampler::henyeyGreenstein(double g) {
  assert(g > -1.0 && g < 1.0);
  PhaseSampler s;
  s.g_ = g;
  return s;
}

PhaseSampler PhaseSampler::tabulated(const std::function<double(double)>& phase) {
  PhaseSampler s;
  s.shares_.push_back(0.0);
  for (int i = 0; i <= kSteps; ++i) s.edges_.push_back(edgeCosine(i));
  for (int i = 0; i < kSteps; ++i) {
    const double a = s.edges_[i], b = s.edges_[i + 1];
    const double mean = (phase(a) + 4.0 * phase(0.5 * (a + b)) + phase(b)) / 6.0;  // Simpson's rule
    s.densities_.push_back(mean);
    s.shares_.push_back(s.shares_.back() + 2.0 * kPi * mean * (b - a));
  }
  s.normalise();
  return s;
}

PhaseSampler PhaseSampler::above(double level) const {
  assert(!edges_.empty());
  PhaseSampler s;
  s.edges_ = edges_;
  s.shares_.push_back(0.0);
  for (int i = 0; i < kSteps; ++i) {
    s.densities_.push_back(std::max(densities_[i] - level, 0.0));
    s.shares_.push_back(s.shares_.back() + 2.0 * kPi * s.densities_.back() * (edges_[i + 1] - edges_[i]));
  }
  s.normalise();
  return s;
}

void PhaseSampler::normalise() {
  const double total = integral_ = shares_.back();
  for (double& d : densities_) d /= total;
  for (double& c : shares_) c /= total;
  int step = 0;
  for (int i = 0; i < kGuides; ++i) {
    while (step + 1 < kSteps && shares_[step + 1] <= static_cast<double>(i) / kGuides) ++step;
    guide_.push_back(static_cast<std::uint16_t>(step));
  }
  step = kSteps - 1;
  for (int i = 0; i < kGuides; ++i) {
    const double place = static_cast<double>(i + 1) / kGuides, sine = place * place;
    while (step > 0 && edges_[step] > 1.0 - 2.0 * sine * sine) --step;
    stepGuide_.push_back(static_cast<std::uint16_t>(step));
  }
}

double PhaseSampler::density(double cosine) const {
  if (edges_.empty()) {
    const double d = 1.0 + g_ * g_ - 2.0 * g_ * cosine;
    return (1.0 - g_ * g_) / (4.0 * kPi * d * std::sqrt(d));
  }
  // No arc cosine: it would take longer than all else here.
  int i = stepGuide_[static_cast<std::size_t>(std::min(placeOf(cosine) * kGuides, kGuides - 1.0))];
  while (i + 1 < kSteps && edges_[i + 1] <= cosine) ++i;
  return densities_[static_cast<std::size_t>(i)];
}

double PhaseSampler::sampleCosine(double u) const {
  if (edges_.empty()) {
    // Henyey and Greenstein 1941; the inverse degenerates as g goes to 0.
    if (std::abs(g_) < 1e-4) return 2.0 * u - 1.0 + 1.5 * g_ * (1.0 - (2.0 * u - 1.0) * (2.0 * u - 1.0));
    const double s = (1.0 - g_ * g_) / (1.0 + g_ * (2.0 * u - 1.0));
    return std::clamp((1.0 + g_ * g_ - s * s) / (2.0 * g_), -1.0, 1.0);
  }
  int i = guide_[static_cast<std::size_t>(u * kGuides)];
  while (i + 1 < kSteps && shares_[i + 1] <= u) ++i;
  const double width = shares_[i + 1] - shares_[i];
  const double f = width > 0.0 ? (u - shares_[i]) / width : 0.5;
  return edges_[i] + std::clamp(f, 0.0, 1.0) * (edges_[i + 1] - edges_[i]);
}

double PhaseSampler::meanCosine() const {
  if (edges_.empty()) return g_;
  double mean = 0.0;
  for (int i = 0; i < kSteps; ++i) mean += (shares_[i + 1] - shares_[i]) * 0.5 * (edges_[i] + edges_[i + 1]);
  return mean;
}

}  // namespace welkin::reference
