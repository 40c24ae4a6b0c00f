// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/cells.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace welkin::noise {
namespace {

constexpr int kReach = 2;  // cells: f2 <= sqrt(3), for the two nearest cells lie within that

// [0, 1) from the upper 24 bits; exact in float.
float unit(std::uint32_t h) {
  return static_cast<float>(h >> 8) * CellLattice::kUnit;
}

}  // namespace

CellLattice::CellLattice(int axes, const std::array<Axis, 3>& axis, std::optional<double> time,
                         double timePeriod)
    : axes_(axes), axis_(axis), time_(time), timePeriod_(timePeriod) {
  assert(axes == 2 || axes == 3);
}

FeaturePlace CellLattice::place(std::uint32_t cellHash) const {
  FeaturePlace p{};
  for (int i = 0; i < axes_; ++i) {
    const std::uint32_t h = mix32(cellHash + static_cast<std::uint32_t>(i + 1) * kAxisStep);
    p.inside[i] = unit(h);
    if (!time_) continue;
    // Between half a cell and a whole one a unit of time, to and fro over a path of length 2.
    double pace = 0.5 + 0.5 * unit(mix32(h));
    if (timePeriod_ > 0.0) pace = 2.0 * std::max(std::round(pace * timePeriod_ / 2.0), 1.0) / timePeriod_;
    const double path = std::fmod(std::fmod(*time_ * pace, 2.0) + 2.0 + 2.0 * p.inside[i], 2.0);
    p.inside[i] = std::min(static_cast<float>(path < 1.0 ? path : 2.0 - path), 0x1.fffffep-1f);
  }
  return p;
}

Distances CellLattice::at(const std::array<double, 3>& position) const {
  std::array<Span, 3> span{};
  for (int i = 0; i < axes_; ++i) span[i] = axis_[i].at(position[i]);
  double first = 1e9, second = 1e9;  // squares
  const int deep = axes_ == 3 ? kReach : 0;
  for (int k = -deep; k <= deep; ++k)
    for (int j = -kReach; j <= kReach; ++j)
      for (int i = -kReach; i <= kReach; ++i) {
        const int cell[3] = {i, j, k};
        std::uint32_t hash = 0;
        for (int a = 0; a < axes_; ++a) hash += axis_[a].hash(axis_[a].moved(span[a].low, cell[a]));
        const FeaturePlace p = place(hash);
        double square = 0.0;
        for (int a = 0; a < axes_; ++a) {
          const double d = (cell[a] - span[a].inside) + static_cast<double>(p.inside[a]);
          square += d * d;
        }
        second = std::min(second, std::max(first, square));
        first = std::min(first, square);
      }
  return {std::sqrt(first), std::sqrt(second)};
}

}  // namespace welkin::noise
