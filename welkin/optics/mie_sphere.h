// SPDX-License-Identifier: Apache-2.0
// Mie's theory for one sphere that does not absorb: C. F. Bohren and D. R. Huffman 1983, "Absorption and
// Scattering of Light by Small Particles", chapter 4. Pure function, safe from any thread.
#pragma once

#include <span>

namespace welkin::optics {

// Adds 2 weight (|S1|^2 + |S2|^2) at scattering angles from 0 to pi in equal steps, both ends included and
// their number odd: angles come in pairs, a and pi - a, about the middle one. x: circumference over
// wavelength; m: refractive index. Takes time as x times the number of angles; good to x = 30,000 at least.
void addMieSphere(double x, double m, double weight, std::span<double> intensity);

}  // namespace welkin::optics
