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
double edgeVersine(int i) {
  const double x = static_cast<double>(i) / kSteps, sine = std::sin(0.5 * kPi * x * x);
  return 2.0 * sine * sine;
}

// A number that rises from 0 to 1 with an angle, about as evenly as the steps do: the root of the half
// angle's sine. No arc cosine: it would take longer than all else here.
float placeOf(float versine) {
  return std::sqrt(std::sqrt(0.5f * versine));
}

}  // namespace

PhaseSampler PhaseSampler::henyeyGreenstein(double g) {
  assert(g > -1.0 && g < 1.0);
  PhaseSampler s;
  s.g_ = g;
  return s;
}

PhaseSampler PhaseSampler::tabulated(const std::function<double(double)>& phase) {
  std::vector<double> densities;
  densities.reserve(kSteps);
  for (int i = 0; i < kSteps; ++i) {
    const double a = 1.0 - edgeVersine(i), b = 1.0 - edgeVersine(i + 1);
    densities.push_back((phase(a) + 4.0 * phase(0.5 * (a + b)) + phase(b)) / 6.0);  // Simpson's rule
  }
  return of(densities);
}

PhaseSampler PhaseSampler::above(double level) const {
  assert(isTabulated());
  std::vector<double> densities;
  densities.reserve(kSteps);
  for (int i = 0; i < kSteps; ++i)
    densities.push_back(std::max(densityIn(static_cast<std::size_t>(i)) - level, 0.0));
  return of(densities);
}

PhaseSampler PhaseSampler::of(const std::vector<double>& densities) {
  PhaseSampler s;
  s.steps_.resize(kSteps + 1);
  for (int i = 0; i <= kSteps; ++i)
    s.steps_[static_cast<std::size_t>(i)].versine = static_cast<float>(edgeVersine(i));
  double total = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    s.steps_[i].share = total;
    total += 2.0 * kPi * densities[i] *
             (static_cast<double>(s.steps_[i + 1].versine) - static_cast<double>(s.steps_[i].versine));
  }
  s.integral_ = total;
  for (std::size_t i = 0; i < kSteps; ++i) {
    s.steps_[i].share /= total;
    s.steps_[i].density = static_cast<float>(densities[i] / total);
  }
  s.steps_[kSteps].share = 1.0;
  std::uint16_t step = 0;
  for (int i = 0; i < kGuides; ++i) {
    while (step + 1 < kSteps && s.steps_[step + 1u].share < static_cast<double>(i) / kGuides) ++step;
    s.guide_.push_back(step);
  }
  step = 0;
  for (int i = 0; i <= kGuides; ++i) {
    // A little less, for what placeOf() rounds.
    const float place = static_cast<float>(i) * (0.999999f / kGuides);
    while (step + 1 < kSteps && placeOf(s.steps_[step + 1u].versine) < place) ++step;
    s.stepGuide_.push_back(step);
  }
  return s;
}

std::size_t PhaseSampler::stepAt(double versine) const {
  const auto v = static_cast<float>(std::clamp(versine, 0.0, 2.0));
  std::size_t i = stepGuide_[static_cast<std::size_t>(placeOf(v) * static_cast<float>(kGuides))];
  while (i + 1 < kSteps && steps_[i + 1].versine <= v) ++i;
  return i;
}

double PhaseSampler::density(double cosine) const {
  if (isTabulated()) return densityIn(stepAt(1.0 - cosine));
  const double d = 1.0 + g_ * g_ - 2.0 * g_ * cosine;
  return (1.0 - g_ * g_) / (4.0 * kPi * d * std::sqrt(d));
}

double PhaseSampler::sampleVersine(double u) const {
  if (!isTabulated()) {
    // Henyey and Greenstein 1941; the inverse degenerates as g goes to 0.
    const double x = 1.0 - 2.0 * u;
    if (std::abs(g_) < 1e-4) return 1.0 - x - 1.5 * g_ * (1.0 - x * x);
    const double s = (1.0 - g_ * g_) / (1.0 + g_ * x);
    return 1.0 - std::clamp((1.0 + g_ * g_ - s * s) / (2.0 * g_), -1.0, 1.0);
  }
  std::size_t i = guide_[std::min(static_cast<std::size_t>(u * kGuides), kGuides - std::size_t{1})];
  while (i + 1 < kSteps && steps_[i + 1].share < u) ++i;
  const Step &a = steps_[i], &b = steps_[i + 1];
  const double width = b.share - a.share, f = width > 0.0 ? (u - a.share) / width : 0.5;
  const auto low = static_cast<double>(a.versine), high = static_cast<double>(b.versine);
  return low + std::clamp(f, 0.0, 1.0) * (high - low);
}

double PhaseSampler::meanCosine() const {
  if (!isTabulated()) return g_;
  double mean = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i)
    mean +=
        (steps_[i + 1].share - steps_[i].share) *
        (1.0 - 0.5 * (static_cast<double>(steps_[i].versine) + static_cast<double>(steps_[i + 1].versine)));
  return mean;
}

}  // namespace welkin::reference
