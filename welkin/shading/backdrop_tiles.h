// SPDX-License-Identifier: Apache-2.0
// Which parts of a perspective picture show the sky alone, or the ground alone: they are drawn by programs
// that do nothing else. A rasteriser on the processor runs both sides of every branch for every pixel, and
// the ground is five times as dear as the sky. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "welkin/shading/view.h"

namespace welkin::shading {

enum class BackdropKind : std::uint8_t {
  kAll,     // the horizon, or a disc
  kSky,     // clear sky
  kGround,  // ground
};

struct BackdropTile {
  BackdropKind kind = BackdropKind::kAll;
  int x = 0, y = 0, width = 0, height = 0;  // pixels, from the bottom left of the picture
};

struct BackdropTiles {
  static constexpr int kMax = 192;
  std::array<BackdropTile, kMax> tiles;
  int count = 0;
};

// A light whose disc is drawn.
struct BackdropDisc {
  glm::vec3 direction{0.0f};  // unit
  float radiusRad = 0.0f;
};

// Tiles that cover the picture, each pixel once. Those of one kind show, in all of their pixels, nothing
// else; the few that may show more are of the kind kAll.
BackdropTiles backdropTiles(const ViewParts& view, int width, int height, double earthRadiusM,
                            const std::array<BackdropDisc, 2>& discs, bool discsAreDrawn);

}  // namespace welkin::shading
