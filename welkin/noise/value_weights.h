// SPDX-License-Identifier: Apache-2.0
// Interpolation between lattice points of value noise along one axis. Private to noise/.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "welkin/noise/value.h"

namespace welkin::noise {

// Points -1 to 2 beside a cell's lower one have taps 0 to 3: those from `first` to `last` weigh something.
struct Taps {
  int first, last;
  int count() const { return last - first + 1; }
};
constexpr Taps tapsOf(Interpolation interpolation) {
  return interpolation == Interpolation::kCubic ? Taps{0, 3} : Taps{1, 2};
}

// What each tap weighs at x, within the cell.
inline std::array<double, 4> weightsAt(Interpolation interpolation, double x) {
  switch (interpolation) {
    case Interpolation::kLinear:
      return {0.0, 1.0 - x, x, 0.0};
    case Interpolation::kCosine: {
      const double f = 0.5 * (1.0 - std::cos(std::numbers::pi * x));
      return {0.0, 1.0 - f, f, 0.0};
    }
    case Interpolation::kCubic:
      break;
  }
  // P x^3 + Q x^2 + R x + S with P = (v3 - v2) - (v0 - v1), Q = v0 - v1 - P, R = v2 - v0, S = v1, sorted by
  // v.
  const double x2 = x * x, x3 = x2 * x;
  return {-x3 + 2 * x2 - x, x3 - 2 * x2 + 1, -x3 + x2 + x, x3 - x2};
}

// Their derivatives by x.
inline std::array<double, 4> weightSlopesAt(Interpolation interpolation, double x) {
  switch (interpolation) {
    case Interpolation::kLinear:
      return {0.0, -1.0, 1.0, 0.0};
    case Interpolation::kCosine: {
      const double slope = 0.5 * std::numbers::pi * std::sin(std::numbers::pi * x);
      return {0.0, -slope, slope, 0.0};
    }
    case Interpolation::kCubic:
      break;
  }
  const double x2 = x * x;
  return {-3 * x2 + 4 * x - 1, 3 * x2 - 4 * x, -3 * x2 + 2 * x + 1, 3 * x2 - 2 * x};
}

// A lattice point's index where it repeats after `period` cells; 0: after 2^32.
constexpr std::uint32_t wrappedCell(std::int64_t i, std::int64_t period) {
  if (period == 0 || (i >= 0 && i < period)) return static_cast<std::uint32_t>(i);
  const std::int64_t r = i % period;
  return static_cast<std::uint32_t>(r < 0 ? r + period : r);
}

}  // namespace welkin::noise
