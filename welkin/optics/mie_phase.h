// SPDX-License-Identifier: Apache-2.0
// Water droplets by Mie's theory, from a table: mean of 450, 550 and 650 nm, lognormal sizes with sigma 0.15,
// with fogbow and glory, which the fit of phase.h does not have. Pure function, safe from any thread.
#pragma once

namespace welkin::optics {

inline constexpr double kLargestMieDropletUm = 40.0;

// 1/sr. c: cosine of the scattering angle. diameterUm is clamped to the table's, from 5. Logarithms are
// linear in the angle and in the logarithm of the diameter; below 0.25 degrees it is constant, and the
// table's steps are too wide for the peak of the largest droplets. Integrals over the sphere are 1 within two
// per cent up to 20 um; normalise.
double phaseMieDroplet(double c, double diameterUm);

}  // namespace welkin::optics
