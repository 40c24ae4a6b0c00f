// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cover.h"

#include <atomic>
#include <cmath>

#include "welkin/core/parallel.h"
#include "welkin/core/units.h"

namespace welkin::field {
namespace {

// Direction i of n, evenly over the upper hemisphere: a Fibonacci lattice (uniform in z, golden-angle steps in azimuth).
glm::vec3 hemisphereDirection(int i, int n) {
  const double z = (i + 0.5) / n;
  const double azimuth = i * kPi * (3.0 - std::sqrt(5.0));
  const double r = std::sqrt(1.0 - z * z);
  return {static_cast<float>(r * std::cos(azimuth)), static_cast<float>(r * std::sin(azimuth)), static_cast<float>(z)};
}

}  // namespace

double measureCover(const CloudField& field, const CoverView& view, int only) {
  std::atomic<int> hidden{0};
  parallelFor(view.directions, 64, [&](std::size_t begin, std::size_t end) {
    int mine = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 d = hemisphereDirection(static_cast<int>(i), view.directions);
      const glm::vec3 eye(0.0f, 0.0f, static_cast<float>(view.eyeM));
      if (field.opticalDepth(eye, d, kCoverOpticalDepth, only) >= kCoverOpticalDepth) ++mine;
    }
    hidden += mine;
  });
  return static_cast<double>(hidden.load()) / view.directions;
}

CloudLayer calibrated(const CloudField& field, int layer, double fraction, const CoverView& view) {
  CloudLayer result = field.layers()[layer];
  auto coverAt = [&](float threshold) {
    result.threshold = threshold;
    const CloudField single(field.sharedNoise(), {result}, field.earthRadiusM() - kEarthRadiusM);
    return measureCover(single, view, 0);
  };
  // The whole sky: nothing may show through, and little is to be gained beyond.
  const double target = std::fmin(fraction, 0.999);
  float low = -4.0f, high = 4.5f;  // cover at `low` >= target > cover at `high`
  for (int i = 0; i < 6 && coverAt(low) < target; ++i) result.extinction *= 1.5f;
  for (int i = 0; i < 11; ++i) {
    const float middle = 0.5f * (low + high);
    (coverAt(middle) >= target ? low : high) = middle;
  }
  // An overcast that is only just thick enough to count as cloud everywhere would show blue through: half a deviation more.
  result.threshold = target >= 0.99 ? low - 0.5f : 0.5f * (low + high);
  return result;
}

}  // namespace welkin::field
