// SPDX-License-Identifier: Apache-2.0
// Numbers of pictures, and how far apart two of them are.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "welkin/core/image.h"

namespace welkin::testing {

// Photometric luminance of linear Rec. 709.
double luminanceOf(glm::vec3 rgb);

glm::vec3 pixel(const Image<float>& picture, int x, int y);

// Bilinear, centres of pixels at (i + 0.5); clamped at the border.
glm::vec3 sample(const Image<float>& picture, double x, double y);

// Mean of rows [y0, y1) of a picture; all of them unless told.
glm::vec3 meanOf(const Image<float>& picture, int y0 = 0, int y1 = -1);

// The first value that is not a finite number of at least 0, or -1 where all are.
long firstBadValue(const Image<float>& picture);

// Differences of two pictures of the same size and kind, in steps of 1/255: the mean of their magnitudes and
// that which 99 of 100 do not exceed.
struct Difference {
  double mean = 0.0, percentile99 = 0.0;
};
Difference difference(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b);

// Mean of the differences of luminance, relative to the mean of both, of two pictures of one size.
double relativeDifference(const Image<float>& a, const Image<float>& b);

// Illuminance in lux, Rec. 709 triple, of a horizontal plane facing up by an equirectangular picture of
// luminance whose top row is the zenith. Each pixel stands for the luminance of all of its solid angle.
glm::vec3 horizontalIlluminance(const Image<float>& equirect);

}  // namespace welkin::testing
