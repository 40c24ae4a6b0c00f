// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/mie_droplets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/optics/mie_sphere.h"

namespace welkin::optics {
namespace {

constexpr double kSpread = 0.15;  // of the logarithms of diameters
constexpr int kSizes = 41;
constexpr double kReach = 3.0;  // of the sizes, in spreads

// Makes the integral over the sphere of what is linear between the angles 1.
void normalise(std::vector<double>& phase) {
  const double step = kPi / (kMieAngles - 1);
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < phase.size(); ++i) {
    // Integrals of a linear function times the sine.
    const double a = step * static_cast<double>(i), slope = (phase[i + 1] - phase[i]) / step;
    sum += phase[i] * std::cos(a) - phase[i + 1] * std::cos(a + step) +
           slope * (std::sin(a + step) - std::sin(a));
  }
  for (double& p : phase) p /= 2.0 * kPi * sum;
}

}  // namespace

Image<float> mieDroplets(double diameterUm) {
  struct Colour {
    std::array<double, 3> wavelengthsUm, indices;
  };
  static constexpr std::array<Colour, 3> kColours = {{
      {{0.640, 0.650, 0.660}, {1.3312, 1.3310, 1.3308}},
      {{0.540, 0.550, 0.560}, {1.3334, 1.3330, 1.3328}},
      {{0.440, 0.450, 0.460}, {1.3374, 1.3370, 1.3366}},
  }};
  const double median = std::clamp(diameterUm, 2.0, 50.0);
  Image<float> table(kMieAngles, 1, 3);
  for (int colour = 0; colour < 3; ++colour) {
    const Colour& of = kColours[static_cast<std::size_t>(colour)];
    std::vector<double> phase(kMieAngles, 0.0);
    for (std::size_t w = 0; w < 3; ++w)
      for (int i = 0; i < kSizes; ++i) {
        const double t = kReach * (2.0 * i / (kSizes - 1) - 1.0);
        const double size = kPi * median * std::exp(kSpread * t) / of.wavelengthsUm[w];
        // A scattered intensity is |S|^2 over the square of the wave number.
        addMieSphere(size, of.indices[w], std::exp(-0.5 * t * t) * of.wavelengthsUm[w] * of.wavelengthsUm[w],
                     phase);
      }
    normalise(phase);
    for (int i = 0; i < kMieAngles; ++i)
      table.at(i, 0, colour) = static_cast<float>(phase[static_cast<std::size_t>(i)]);
  }
  return table;
}

}  // namespace welkin::optics
