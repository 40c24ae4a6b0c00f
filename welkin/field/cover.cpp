// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cover.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>

#include "welkin/core/parallel.h"
#include "welkin/core/units.h"

namespace welkin::field {
namespace {

constexpr std::size_t kGrain = 64;  // directions that a thread takes at a time

constexpr float kGreatestThreshold = 4.5f;  // no cloud at all
constexpr int kBisections = 11;             // to 0.004 deviations
constexpr float kThickening = 1.5f;
constexpr int kMostThickenings = 6;
static_assert(CoverSearch::kMostSteps == 1 + kMostThickenings + kBisections);

float depthInDirection(const CloudField& field, const CoverView& view, int direction, int only) {
  const glm::vec3 eye(0.0f, 0.0f, static_cast<float>(view.eyeM));
  return field.opticalDepth(eye, hemisphereDirection(direction, view.directions), kCoverOpticalDepth, only);
}

}  // namespace

// A Fibonacci lattice (uniform in z, golden-angle steps
// in azimuth).
glm::vec3 hemisphereDirection(int i, int n) {
  const double z = (i + 0.5) / n;
  const double azimuth = i * kPi * (3.0 - std::sqrt(5.0));
  const double r = std::sqrt(1.0 - z * z);
  return {static_cast<float>(r * std::cos(azimuth)), static_cast<float>(r * std::sin(azimuth)),
          static_cast<float>(z)};
}

double measureCover(const CloudField& field, const CoverView& view, int only) {
  return coverOf(layerOpticalDepths(field, view, only));
}

std::vector<float> layerOpticalDepths(const CloudField& field, const CoverView& view, int layer) {
  std::vector<float> depths(view.directions);
  parallelFor(depths.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      depths[i] = depthInDirection(field, view, static_cast<int>(i), layer);
  });
  return depths;
}

double coverOf(std::span<const float> opticalDepths) {
  const auto hidden = std::count_if(opticalDepths.begin(), opticalDepths.end(),
                                    [](float tau) { return tau >= kCoverOpticalDepth; });
  return static_cast<double>(hidden) / static_cast<double>(opticalDepths.size());
}

CloudLayer calibrated(const CloudField& field, int layer, double fraction, const CoverView& view) {
  CoverSearch search;
  search.start(field.sharedNoise(), field.earthRadiusM() - kEarthRadiusM, field.layers()[layer], fraction,
               view);
  while (!search.done()) search.step();
  return search.layer();
}

void CoverSearch::start(const std::shared_ptr<const CloudNoise>& noise, double groundAltitudeM,
                        const CloudLayer& layer, double fraction, const CoverView& view) {
  if (!single_ || single_->sharedNoise() != noise ||
      single_->earthRadiusM() != kEarthRadiusM + groundAltitudeM)
    single_.emplace(noise, std::vector{layer}, groundAltitudeM);
  view_ = view;
  result_ = layer;
  fraction_ = fraction;
  // The whole sky: nothing may show through, and little is to be gained beyond.
  target_ = std::fmin(fraction, 0.999) * view.directions;
  low_ = kLeastThreshold;
  high_ = kGreatestThreshold;
  directions_.resize(view.directions);
  std::iota(directions_.begin(), directions_.end(), 0);
  hides_.resize(directions_.size());
  hiddenAtLow_ = hiddenAtHigh_ = 0;
  thickenings_ = bisections_ = 0;
  looked_ = false;
  result_.threshold = low_;
}

bool CoverSearch::done() const {
  return bisections_ == kBisections;
}

bool CoverSearch::tooThin() const {
  return thickenings_ < kMostThickenings && static_cast<double>(hiddenAtLow_) < target_;
}

// Sorts directions_[begin, end) into those that the layer hides and then those that it does not: how many it
// hides.
std::size_t CoverSearch::lookAt(std::size_t begin, std::size_t end) {
  single_->setLayers(std::span(&result_, 1));
  parallelFor(end - begin, kGrain, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = begin + from; i < begin + to; ++i)
      hides_[directions_[i]] = depthInDirection(*single_, view_, directions_[i], 0) >= kCoverOpticalDepth;
  });
  const auto first = directions_.begin() + static_cast<std::ptrdiff_t>(begin),
             last = directions_.begin() + static_cast<std::ptrdiff_t>(end);
  return static_cast<std::size_t>(std::partition(first, last, [&](int d) { return hides_[d]; }) - first);
}

// More extinction and a lower threshold can only hide more. So a direction that is hidden stays so while
// either goes that way, and only those are looked at again that may still change: in all, about three looks
// at each instead of one a step.
void CoverSearch::step() {
  if (done()) return;
  if (!looked_ || tooThin()) {
    if (looked_) {
      result_.extinction *= kThickening;
      ++thickenings_;
    }
    hiddenAtLow_ += lookAt(hiddenAtLow_, directions_.size());
    looked_ = true;
    return;
  }
  if (bisections_ == 0) directions_.resize(hiddenAtLow_);  // hidden at low_, not known at high_
  result_.threshold = 0.5f * (low_ + high_);
  const std::size_t hidden = lookAt(0, directions_.size());
  const auto open = directions_.begin() + static_cast<std::ptrdiff_t>(hidden);
  if (static_cast<double>(hiddenAtHigh_ + hidden) >= target_) {
    low_ = result_.threshold;
    directions_.erase(open, directions_.end());
  } else {
    high_ = result_.threshold;
    hiddenAtHigh_ += hidden;
    directions_.erase(directions_.begin(), open);
  }
  // An overcast that is only just thick enough to count as cloud everywhere would show blue through: half a
  // deviation more.
  if (++bisections_ < kBisections) return;
  // What lies beneath the eye hides none of the sky however much of it there is.
  if (target_ == 0.0 && hiddenAtLow_ == 0)
    result_.threshold = kLeastThreshold;
  else
    result_.threshold = fraction_ >= 0.99 ? low_ - 0.5f : 0.5f * (low_ + high_);
}

void CoverSearch::addOpticalDepths(std::span<float> sums) {
  single_->setLayers(std::span(&result_, 1));
  parallelFor(sums.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      sums[i] += depthInDirection(*single_, view_, static_cast<int>(i), 0);
  });
}

}  // namespace welkin::field
