// SPDX-License-Identifier: Apache-2.0
// How rain scatters each colour: the rainbows, with Alexander's dark band between them and the brighter sky
// inside. From a table of Mie's theory, made by bench/rain_phase.cpp. Pure function, safe from any thread.
#pragma once

#include "welkin/core/image.h"

namespace welkin::optics {

// Phase function in 1/sr, kRainAngles x 1 x 4 (linear Rec. 709, and of light scattered twice the mean of the
// colours), at scattering angles from 0 to pi in equal steps, the first and the last texel included; between
// them linear, and so the integral of each colour over the sphere is 1. Of round drops of 0.2 to 4 mm as in
// rain of 10 mm/h (in 1 to 50 mm/h the red of the primary bow is 8 % weaker to 4 % stronger, the other
// colours less), seen over the sun's disc. Without diffraction, half of what drops scatter, all of which goes
// on within some hundredths of a degree: the extinction that belongs to this is the drops' cross-section,
// once. Mean cosine 0.77.
inline constexpr int kRainAngles = 2049;
Image<float> rainPhase();

}  // namespace welkin::optics
