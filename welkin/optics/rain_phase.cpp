// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/rain_phase.h"

#include <cmath>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/optics/rain_table.h"

namespace welkin::optics {
namespace {

// Fills the fourth channel: turns one after the other multiply the coefficients of Legendre's series.
void addTwice(Image<float>& phase) {
  constexpr int kOrders = 64;  // bows are narrower and, scattered once more, gone
  constexpr double kStep = kPi / (kRainAngles - 1);
  std::vector<double> cosine(kRainAngles), mean(kRainAngles), twice(kRainAngles, 0.0),
      before(kRainAngles, 0.0), legendre(kRainAngles, 1.0);
  for (int i = 0; i < kRainAngles; ++i) {
    cosine[i] = std::cos(kStep * i);
    mean[i] = static_cast<double>(phase.at(i, 0, 0) + phase.at(i, 0, 1) + phase.at(i, 0, 2)) / 3.0;
  }
  for (int n = 0; n < kOrders; ++n) {
    double coefficient = 0.0;
    for (int i = 0; i < kRainAngles; ++i)
      coefficient += 2.0 * kPi * kStep * std::sin(kStep * i) * mean[i] * legendre[i];
    for (int i = 0; i < kRainAngles; ++i) {
      twice[i] += (2.0 * n + 1.0) / (4.0 * kPi) * coefficient * coefficient * legendre[i];
      const double next = ((2.0 * n + 1.0) * cosine[i] * legendre[i] - n * before[i]) / (n + 1.0);
      before[i] = legendre[i];
      legendre[i] = next;
    }
  }
  for (int i = 0; i < kRainAngles; ++i) phase.at(i, 0, 3) = static_cast<float>(twice[i]);
}

}  // namespace

Image<float> rainPhase() {
  Image<float> phase(kRainAngles, 1, 4);
  fillColours(detail::kRainRows, phase);
  addTwice(phase);
  return phase;
}

}  // namespace welkin::optics
