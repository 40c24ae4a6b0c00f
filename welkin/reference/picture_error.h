// SPDX-License-Identifier: Apache-2.0
// How far a linear picture is from another that is taken for the truth, in numbers and as maps to look at.
#pragma once

#include <span>

#include "welkin/core/image.h"

namespace welkin::reference {

// Of luminances; relative ones are shares. What is darker than a hundredth of the truth's median counts as
// that dark where it is divided by, so that black pixels weigh no more than others.
struct PictureError {
  double mean = 0.0, meanOfTruth = 0.0;  // luminance, in the pictures' unit
  double bias = 0.0;                     // of the mean
  double relative = 0.0;                 // mean of the pixels' relative errors, all taken positive
  double relativeRms = 0.0;              // root of the mean of their squares
  double largest = 0.0;                  // relative error of a pixel, positive
};

// Two pictures of one size, of 1 or of 3 channels, linear Rec. 709 (asserted). weights: of the pixels, one
// each; none: all the same. Throws ParameterError where they have no sum, or the truth is black.
PictureError errorOf(const Image<float>& picture, const Image<float>& truth,
                     std::span<const float> weights = {});

// Relative errors of the luminances, with their signs.
Image<float> biasMap(const Image<float>& picture, const Image<float>& truth);

// The same for a screen, sRGB-encoded: blue where the picture is too dark by `range` or more, grey where it
// is right, red where it is too bright.
Image<float> biasColours(const Image<float>& bias, double range);

// FLIP's map for a screen: black for 0 over violet and orange to pale yellow for 1 (the colours of "magma" by
// S. van der Walt and N. Smith).
Image<float> flipColours(const Image<float>& flip);

}  // namespace welkin::reference
