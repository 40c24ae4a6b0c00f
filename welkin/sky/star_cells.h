// SPDX-License-Identifier: Apache-2.0
// Stars and planets as pictures draw them: spots of shaders/lib/stars.glsl. Stars are sorted into its
// texture, to be looked up by direction; planets are few, move among the stars, and are a list.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>

#include "welkin/core/image.h"
#include "welkin/sky/ephemeris.h"
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

// As planetShare() of the shaders takes it.
struct PlanetSpot {
  glm::vec3 direction{0, 0, 1};  // unit, east-north-up
  float leastRad = 0.0f;
  glm::vec3 illuminance{0};  // above the atmosphere, facing it, lux, linear Rec. 709
  float brighter = 0.0f;     // magnitudes brighter than V = 4.5
};
struct PlanetSpots {
  std::array<PlanetSpot, kPlanetCount> spots;
  int count = 0;  // that are drawn
};
// Those above the horizon of an eye, or not far below it, for pictures with pixels of the given size. They go
// with the stars by day, but for those whose spot is brighter than 150 cd/m2, a thirtieth of a bright sky:
// Venus at noon, where pixels are smaller than 0.03 degrees.
PlanetSpots planetSpots(const Ephemeris& ephemeris, double eyeM, float pixelRad);

}  // namespace welkin::sky
