// SPDX-License-Identifier: Apache-2.0
// Linear Rec. 709 (ITU-R BT.709) as photometry.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace welkin {

// Of an sRGB-encoded value in [0, 1]: IEC 61966-2-1.
template <class T>
T linearOfSrgb(T srgb) {
  return srgb <= T(0.04045) ? srgb / T(12.92) : std::pow((srgb + T(0.055)) / T(1.055), T(2.4));
}

// Luminance of a linear Rec. 709 triple, in the unit of the triple.
template <class T>
constexpr T luminanceOf(const T* rgb) {
  return T(0.2126) * rgb[0] + T(0.7152) * rgb[1] + T(0.0722) * rgb[2];
}

// Of CIE 1931 tristimulus values; white is D65.
inline glm::dvec3 rgbFromXyz(const glm::dvec3& xyz) {
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

}  // namespace welkin
