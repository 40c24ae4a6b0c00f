// SPDX-License-Identifier: Apache-2.0
// From real numbers in [0, 1] to the integers of picture files.
#pragma once

#include <cstdint>

#include "welkin/core/image.h"

namespace welkin::io {

// Throws ParameterError that names the first pixel and channel with a NaN or an infinity.
void requireFinite(const Image<float>& image);

// To 0..255 with dithering: clear skies are so smooth that plain rounding shows bands. The threshold is
// interleaved gradient noise, whose error lies mostly at high spatial frequencies (J. Jimenez 2014, "Next
// Generation Post Processing in Call of Duty: Advanced Warfare"), the same for all channels of a pixel, so no
// colour noise. A pure function of position and value; the mean over an area is kept; multiples of 1/255 are
// exact. Values outside [0, 1] are clamped. Throws as requireFinite.
Image<std::uint8_t> quantise8(const Image<float>& image);

// To 0..65535, rounded to nearest. Values outside [0, 1] are clamped. Throws as requireFinite.
Image<std::uint16_t> quantise16(const Image<float>& image);

}  // namespace welkin::io
