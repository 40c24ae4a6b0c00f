// SPDX-License-Identifier: Apache-2.0
// Where samples of a pixel lie that are taken one after the other, in stills and live: from the first on
// evenly spread. Pure.
#pragma once

#include <glm/vec2.hpp>

namespace welkin::render {

// Within the pixel, from its middle, in [-0.5, 0.5): the R2 sequence (M. Roberts 2018, "The Unreasonable
// Effectiveness of Quasirandom Sequences"). The first is the middle itself: where one is enough, it shows
// that.
glm::vec2 jitterPx(int i);

// Along the ray and towards the sun, in [0, 1): Sobol's sequence (I. M. Sobol' 1967), the first 2, 4, 8, ...
// of which are equidistant each way, so that their mean is free of what dither is coarsest in.
glm::vec2 jitterStep(int i);

}  // namespace welkin::render
