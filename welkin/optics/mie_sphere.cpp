// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/mie_sphere.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "welkin/core/units.h"

namespace welkin::optics {
namespace {

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

}  // namespace

void addMieSphere(double x, double m, double weight, std::span<double> intensity) {
  assert(intensity.size() % 2 == 1);
  const Coefficients c = coefficientsOf(x, m);
  const std::size_t steps = intensity.size() - 1, count = steps / 2 + 1;
  // Sums over odd and even n of (a + b) (pi + tau) and (a - b) (pi - tau): what they are at a, and, with the
  // signs of the orders, at pi - a.
  std::vector<double> cosine(count), pi(count, 1.0), piBefore(count, 0.0);
  for (std::size_t i = 0; i < count; ++i)
    cosine[i] = std::cos(kPi * static_cast<double>(i) / static_cast<double>(steps));
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
      intensity[steps - i] += weight * (s[4] * s[4] + s[5] * s[5] + s[6] * s[6] + s[7] * s[7]);
  }
}

}  // namespace welkin::optics
