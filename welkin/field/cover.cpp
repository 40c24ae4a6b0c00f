// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cover.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "welkin/core/parallel.h"
#include "welkin/core/units.h"

namespace welkin::field {
namespace {

constexpr std::size_t kGrain = 64;  // directions that a thread takes at a time

constexpr float kGreatestThreshold = 4.5f;  // no cloud at all
constexpr int kBisections = 11;             // to 0.004 deviations
constexpr float kThickening = 1.5f;
constexpr int kMostThickenings = 6;

float depthInDirection(const CloudField& field, const CoverView& view, int direction, int only) {
  const glm::vec3 eye(0.0f, 0.0f, static_cast<float>(view.eyeM));
  return field.opticalDepth(eye, hemisphereDirection(direction, view.directions), kCoverOpticalDepth, only);
}

// Splits `directions` into those that the layer hides and those that it does not, each in order.
struct Split {
  std::vector<int> hidden, open;
};
Split split(const CloudField& field, const CloudLayer& layer, const CoverView& view,
            const std::vector<int>& directions) {
  const CloudField single(field.sharedNoise(), {layer}, field.earthRadiusM() - kEarthRadiusM);
  std::vector<char> hides(directions.size());
  parallelFor(directions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      hides[i] = depthInDirection(single, view, directions[i], 0) >= kCoverOpticalDepth;
  });
  Split s;
  for (std::size_t i = 0; i < directions.size(); ++i) (hides[i] ? s.hidden : s.open).push_back(directions[i]);
  return s;
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
  CloudLayer result = field.layers()[layer];
  // The whole sky: nothing may show through, and little is to be gained beyond.
  const double target = std::fmin(fraction, 0.999) * view.directions;
  float low = kLeastThreshold, high = kGreatestThreshold;

  // More extinction and a lower threshold can only hide more. So a direction that is hidden stays so while
  // either goes that way, and only those are looked at again that may still change: in all, about three looks
  // at each instead of one a step.
  std::vector<int> directions(view.directions);
  std::iota(directions.begin(), directions.end(), 0);
  result.threshold = low;
  Split atLow = split(field, result, view, directions);
  for (int i = 0; i < kMostThickenings && static_cast<double>(atLow.hidden.size()) < target; ++i) {
    result.extinction *= kThickening;
    Split more = split(field, result, view, atLow.open);
    atLow.hidden.insert(atLow.hidden.end(), more.hidden.begin(), more.hidden.end());
    atLow.open = std::move(more.open);
  }

  std::vector<int> undecided = std::move(atLow.hidden);  // hidden at `low`, not known at `high`
  std::size_t hiddenAtHigh = 0;
  for (int i = 0; i < kBisections; ++i) {
    result.threshold = 0.5f * (low + high);
    Split s = split(field, result, view, undecided);
    if (static_cast<double>(hiddenAtHigh + s.hidden.size()) >= target) {
      low = result.threshold;
      undecided = std::move(s.hidden);
    } else {
      high = result.threshold;
      hiddenAtHigh += s.hidden.size();
      undecided = std::move(s.open);
    }
  }
  // An overcast that is only just thick enough to count as cloud everywhere would show blue through: half a
  // deviation more.
  result.threshold = fraction >= 0.99 ? low - 0.5f : 0.5f * (low + high);
  return result;
}

}  // namespace welkin::field
