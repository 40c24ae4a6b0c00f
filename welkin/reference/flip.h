// SPDX-License-Identifier: Apache-2.0
// How different two pictures look when one is swapped for the other: P. Andersson, J. Nilsson,
// T. Akenine-Moeller, M. Oskarsson, K. Astroem and M. D. Fairchild 2020, "FLIP: A Difference Evaluator for
// Alternating Images", with the constants of that paper.
#pragma once

#include "welkin/core/image.h"

namespace welkin::reference {

// Pixels a degree for a screen 0.7 m wide with 3840 pixels, seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.0206;

// At each pixel 0 (none) to 1. a, b: three channels, sRGB-encoded in [0, 1], of one size (asserted). Which is
// which makes no difference.
Image<float> flipOf(const Image<float>& a, const Image<float>& b,
                    double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace welkin::reference
