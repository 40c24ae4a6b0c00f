// SPDX-License-Identifier: Apache-2.0
// How cloud droplets scatter each colour, computed by Mie's theory: fogbow, glory and corona with their
// colours, which neither the fit of phase.h nor the mean over wavelengths of mie_phase.h has. Pure function,
// safe from any thread; takes part of a second.
#pragma once

#include "welkin/core/image.h"

namespace welkin::optics {

// Phase function in 1/sr, kMieAngles x 1 x 3 (red, green, blue: means over 30 nm about 650, 550, 450 nm), at
// scattering angles from 0 to pi in equal steps, the first and the last texel included; between them linear,
// and so the integral of each colour over the sphere is 1. diameterUm: median of a lognormal spread of 0.15,
// in micrometres, clamped to 2 to 50. C. F. Bohren and D. R. Huffman 1983, "Absorption and Scattering of
// Light by Small Particles", chapter 4; indices of water: G. M. Hale and M. R. Querry 1973, "Optical
// Constants of Water in the 200-nm to 200-um Wavelength Region".
inline constexpr int kMieAngles = 2049;
Image<float> mieDroplets(double diameterUm);

}  // namespace welkin::optics
