// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/mie_droplets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "welkin/core/units.h"

namespace welkin::optics {
namespace {

constexpr int kHalf = kMieAngles / 2;  // angles come in pairs, a and pi - a, about the middle one
constexpr double kSpread = 0.15;       // of the logarithms of diameters
constexpr int kSizes = 41;
constexpr double kReach = 3.0;  // of the sizes, in spreads

// Coefficients a and b of a sphere of real index m and size parameter x.
struct Coefficients {
  std::vector<std::complex<double>> a, b;  // from order 1
};
Coefficients coefficientsOf(double x, double m) {
  const int orders = static_cast<int>(x + 4.0 * std::cbrt(x) + 2.0);
  const int start = std::max(orders, static_cast<int>(m * x)) + 16;
  // The logarithmic derivative falls stably, the Riccati-Bessel functions rise.
  std::vector<double> derivative(static_cast<std::size_t>(start) + 1, 0.0);
  for (std::size_t n = derivative.size() - 1; n > 0; --n) {
    const double r = static_cast<double>(n) / (m * x);
    derivative[n - 1] = r - 1.0 / (derivative[n] + r);
  }
  Coefficients c;
  double psiBefore = std::cos(x), psi = std::sin(x), chiBefore = -std::sin(x), chi = std::cos(x);
  for (int n = 1; n <= orders; ++n) {
    const double psiNext = (2.0 * n - 1.0) / x * psi - psiBefore,
                 chiNext = (2.0 * n - 1.0) / x * chi - chiBefore;
    const std::complex<double> xi(psi, -chi), xiNext(psiNext, -chiNext);
    const double d = derivative[static_cast<std::size_t>(n)], forA = d / m + n / x, forB = d * m + n / x;
    c.a.push_back((forA * psiNext - psi) / (forA * xiNext - xi));
    c.b.push_back((forB * psiNext - psi) / (forB * xiNext - xi));
    psiBefore = psi;
    psi = psiNext;
    chiBefore = chi;
    chi = chiNext;
  }
  return c;
}

// Adds weight (|S1|^2 + |S2|^2) of a sphere at all angles.
void addSphere(double x, double m, double weight, std::vector<double>& intensity) {
  const Coefficients c = coefficientsOf(x, m);
  const std::size_t count = kHalf + 1;
  // Sums over odd and even n of (a + b) (pi + tau) and (a - b) (pi - tau): what they are at a, and, with the
  // signs of the orders, at pi - a.
  std::vector<double> cosine(count), pi(count, 1.0), piBefore(count, 0.0);
  for (std::size_t i = 0; i < count; ++i)
    cosine[i] = std::cos(kPi * static_cast<double>(i) / (kMieAngles - 1));
  std::vector<std::array<double, 8>> sums(count);  // plus and minus here, plus and minus there; re, im
  for (std::size_t k = 0; k < c.a.size(); ++k) {
    const double n = static_cast<double>(k) + 1.0, factor = (2.0 * n + 1.0) / (n * (n + 1.0));
    const std::complex<double> plus = factor * (c.a[k] + c.b[k]), minus = factor * (c.a[k] - c.b[k]);
    const double sign = k % 2 == 0 ? 1.0 : -1.0;  // pi(pi - a) = sign pi(a), tau(pi - a) = -sign tau(a)
    for (std::size_t i = 0; i < count; ++i) {
      const double tau = n * cosine[i] * pi[i] - (n + 1.0) * piBefore[i];
      const double sum = pi[i] + tau, difference = pi[i] - tau;
      auto& s = sums[i];
      s[0] += plus.real() * sum;
      s[1] += plus.imag() * sum;
      s[2] += minus.real() * difference;
      s[3] += minus.imag() * difference;
      s[4] += sign * plus.real() * difference;
      s[5] += sign * plus.imag() * difference;
      s[6] += sign * minus.real() * sum;
      s[7] += sign * minus.imag() * sum;
      const double next = ((2.0 * n + 1.0) * cosine[i] * pi[i] - (n + 1.0) * piBefore[i]) / n;
      piBefore[i] = pi[i];
      pi[i] = next;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto& s = sums[i];
    intensity[i] += weight * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + s[3] * s[3]);
    if (i + 1 < count)
      intensity[kMieAngles - 1 - i] += weight * (s[4] * s[4] + s[5] * s[5] + s[6] * s[6] + s[7] * s[7]);
  }
}

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
        addSphere(size, of.indices[w], std::exp(-0.5 * t * t) * of.wavelengthsUm[w] * of.wavelengthsUm[w],
                  phase);
      }
    normalise(phase);
    for (int i = 0; i < kMieAngles; ++i)
      table.at(i, 0, colour) = static_cast<float>(phase[static_cast<std::size_t>(i)]);
  }
  return table;
}

}  // namespace welkin::optics
