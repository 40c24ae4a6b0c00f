// SPDX-License-Identifier: Apache-2.0
// Stars sorted for pictures that look them up by direction: the texture of shaders/lib/stars.glsl.
//
// Every star is a round spot 3.5 pixels wide, of which half stands out. Those brighter than V = 4.5 send a
// share of their light into a wider one, as lenses and eyes do: where a pixel cannot become whiter, bright
// stars are larger.
#pragma once

#include <span>

#include "welkin/core/image.h"
#include "welkin/sky/stars.h"

namespace welkin::sky {

struct StarCells {
  Image<float> texels;  // RGBA
  int cells = 0;        // along a side of each of the six faces
};

// Cells serve all pictures whose pixels are no larger than those of their level, and are best for the level's
// own.
constexpr int kStarLevels = 7;
int starLevel(float pixelRad);
StarCells starCells(std::span<const StarLight> stars, int level);

// Share of the stars' light that is drawn: all of it when the sun is down, none from 3 degrees up, where the
// sky outshines them a hundred times in all but a telescope's picture.
float starlightShare(double sunElevationDeg);

}  // namespace welkin::sky
