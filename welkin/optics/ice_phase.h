// SPDX-License-Identifier: Apache-2.0
// How the crystals of ice clouds scatter each colour: the halo of 22 degrees, dark inside and red at its
// inner edge, and the faint one of 46. From a table of rays through crystals, made by bench/ice_phase.cpp.
// Pure function, safe from any thread.
#pragma once

#include "welkin/core/image.h"

namespace welkin::optics {

// Phase function in 1/sr, kIceAngles x 1 x 4 (linear Rec. 709, and the mean of the colours), at scattering
// angles from 0 to pi in equal steps, the first and the last texel included; between them linear, and so the
// integral of each colour over the sphere is 1. The narrow lobe is that of phaseIce() (optics/phase.h), 0.55
// of the light, for diffraction and for rays that leave as they came, which are 0.57; the rest is by
// hexagonal columns and plates in all positions, of which 37 in a hundred have smooth faces, seen over the
// sun's disc. The extinction that belongs to this counts both, as for phaseIce(). Mean cosine 0.75, as of
// that.
inline constexpr int kIceAngles = 2049;
Image<float> icePhase();

}  // namespace welkin::optics
