// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/cellular.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/random.h"

namespace welkin::noise {
namespace {

int wrap(int i, int n) {
  const int m = i % n;
  return m < 0 ? m + n : m;
}

// Splits a coordinate into its cell in [0, n) and the place within.
struct Place {
  int cell;
  float inside;
};
Place place(float x, int n) {
  const float f = std::floor(x);
  return {wrap(static_cast<int>(f), n), x - f};
}

}  // namespace

Cellular::Cellular(std::uint64_t seed, glm::ivec3 period) : period_(period) {
  points_.resize(static_cast<std::size_t>(period.x + 2) * (period.y + 2) * (period.z + 2));
  std::size_t n = 0;
  for (int k = -1; k <= period.z; ++k)
    for (int j = -1; j <= period.y; ++j)
      for (int i = -1; i <= period.x; ++i) {
        Random random(hashOf(seed, wrap(i, period.x), wrap(j, period.y), wrap(k, period.z)));
        const float x = random.uniform(), y = random.uniform(), z = random.uniform();
        points_[n++] = {x, y, z};
      }
}

float Cellular::f1(float x, float y, float z) const {
  const Place px = place(x, period_.x), py = place(y, period_.y), pz = place(z, period_.z);
  float best = 1e9f;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const glm::vec3& q = point(px.cell + i, py.cell + j, pz.cell + k);
        const float dx = q.x + static_cast<float>(i - 1) - px.inside;
        const float dy = q.y + static_cast<float>(j - 1) - py.inside;
        const float dz = q.z + static_cast<float>(k - 1) - pz.inside;
        best = std::min(best, dx * dx + dy * dy + dz * dz);
      }
  return std::sqrt(best);
}

float Cellular::f1(float x, float y) const {
  const Place px = place(x, period_.x), py = place(y, period_.y);
  float best = 1e9f;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const glm::vec3& q = point(px.cell + i, py.cell + j, 1);
      const float dx = q.x + static_cast<float>(i - 1) - px.inside;
      const float dy = q.y + static_cast<float>(j - 1) - py.inside;
      best = std::min(best, dx * dx + dy * dy);
    }
  return std::sqrt(best);
}

}  // namespace welkin::noise
