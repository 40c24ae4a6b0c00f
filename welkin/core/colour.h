// SPDX-License-Identifier: Apache-2.0
// Linear Rec. 709 (ITU-R BT.709) as photometry.
#pragma once

namespace welkin {

// Luminance of a linear Rec. 709 triple, in the unit of the triple.
constexpr float luminanceOf(const float* rgb) {
  return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

}  // namespace welkin
