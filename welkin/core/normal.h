// SPDX-License-Identifier: Apache-2.0
// The standard normal distribution.
#pragma once

#include <cmath>

namespace welkin {

// The number below which it is with chance p, 0 < p < 1: M. Abramowitz and I. Stegun 1964, 26.2.23, absolute
// error below 4.5e-4.
inline double normalQuantile(double p) {
  const bool upper = p > 0.5;
  const double t = std::sqrt(-2.0 * std::log(upper ? 1.0 - p : p));
  const double z =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return upper ? z : -z;
}

// The chance that it is below x.
inline double normalBelow(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

}  // namespace welkin
