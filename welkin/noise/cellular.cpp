// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/cellular.h"

#include <algorithm>
#include <array>
#include <cassert>
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

constexpr float kFar = 1e9f;

// A feature point as a row of samples sees it: its place along the row, and the square of its distance from
// the row.
template <int N>
struct Column {
  std::array<float, N> x, away;
};

// Lowers the squared distances of a row to those from the N points of cell `cell`, for the samples in that
// cell and the two beside.
template <int N>
void lower(std::span<float> out, float step, int cell, const Column<N>& points) {
  const int n = static_cast<int>(out.size());
  auto firstAtOrBeyond = [&](int x) {
    return std::clamp(static_cast<int>(std::ceil(static_cast<float>(x) / step - 0.5f)), 0, n);
  };
  const int end = firstAtOrBeyond(cell + 2);
  for (int s = firstAtOrBeyond(cell - 1); s < end; ++s) {
    const float x = (static_cast<float>(s) + 0.5f) * step;
    float best = out[s];
    for (int i = 0; i < N; ++i) {
      const float d = points.x[i] - x;
      const float square = d * d + points.away[i];
      best = square < best ? square : best;
    }
    out[s] = best;
  }
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
  float best = kFar;
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
  float best = kFar;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const glm::vec3& q = point(px.cell + i, py.cell + j, 1);
      const float dx = q.x + static_cast<float>(i - 1) - px.inside;
      const float dy = q.y + static_cast<float>(j - 1) - py.inside;
      best = std::min(best, dx * dx + dy * dy);
    }
  return std::sqrt(best);
}

void Cellular::f1Row(std::span<float> out, float step, float y, float z) const {
  assert(static_cast<float>(out.size()) * step <= static_cast<float>(period_.x) * 1.0001f);
  const Place py = place(y, period_.y), pz = place(z, period_.z);
  std::fill(out.begin(), out.end(), kFar);
  for (int cell = -1; cell <= period_.x; ++cell) {
    Column<9> points;
    for (int k = 0, n = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j, ++n) {
        const glm::vec3& q = point(cell + 1, py.cell + j, pz.cell + k);
        const float dy = q.y + static_cast<float>(j - 1) - py.inside;
        const float dz = q.z + static_cast<float>(k - 1) - pz.inside;
        points.x[n] = q.x + static_cast<float>(cell);
        points.away[n] = dy * dy + dz * dz;
      }
    lower(out, step, cell, points);
  }
  for (float& v : out) v = std::sqrt(v);
}

void Cellular::f1Row(std::span<float> out, float step, float y) const {
  assert(static_cast<float>(out.size()) * step <= static_cast<float>(period_.x) * 1.0001f);
  const Place py = place(y, period_.y);
  std::fill(out.begin(), out.end(), kFar);
  for (int cell = -1; cell <= period_.x; ++cell) {
    Column<3> points;
    for (int j = 0; j < 3; ++j) {
      const glm::vec3& q = point(cell + 1, py.cell + j, 1);
      const float dy = q.y + static_cast<float>(j - 1) - py.inside;
      points.x[j] = q.x + static_cast<float>(cell);
      points.away[j] = dy * dy;
    }
    lower(out, step, cell, points);
  }
  for (float& v : out) v = std::sqrt(v);
}

}  // namespace welkin::noise
