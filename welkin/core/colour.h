// SPDX-License-Identifier: Apache-2.0
// Linear Rec. 709 (ITU-R BT.709) as photometry.
#pragma once

#include <cmath>

namespace welkin {

// Of an sRGB-encoded value in [0, 1]: IEC 61966-2-1.
template <class T>
T linearOfSrgb(T srgb) {
  return srgb <= T(0.04045) ? srgb / T(12.92) : std::pow((srgb + T(0.055)) / T(1.055), T(2.4));
}

// Luminance of a linear Rec. 709 triple, in the unit of the triple.
constexpr float luminanceOf(const float* rgb) {
  return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

}  // namespace welkin
