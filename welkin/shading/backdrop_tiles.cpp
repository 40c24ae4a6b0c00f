// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/backdrop_tiles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace welkin::shading {
namespace {

constexpr int kMaxBlocks = 40;  // a side

struct Cone {
  glm::dvec3 axis;
  double angle;  // that holds all rays
};

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return 2.0 * std::asin(std::min(0.5 * glm::length(a - b), 1.0));  // exact for small ones
}

// The rays of a block lie between those of its corners, and so within the cone about the middle one that
// holds them.
Cone coneOf(const ViewParts& view, double x0, double y0, double x1, double y1) {
  const auto ray = [&](double x, double y) {
    return glm::normalize(glm::dmat3(view.enuFromCamera) * glm::dvec3(view.rayScale.x * x + view.rayScale.z,
                                                                      view.rayScale.y * y + view.rayScale.w,
                                                                      -1.0));
  };
  Cone cone{ray(0.5 * (x0 + x1), 0.5 * (y0 + y1)), 0.0};
  for (const double x : {x0, x1})
    for (const double y : {y0, y1}) cone.angle = std::max(cone.angle, angleBetween(cone.axis, ray(x, y)));
  cone.angle += 1e-4;  // for the shader's floats
  return cone;
}

}  // namespace

BackdropTiles backdropTiles(const ViewParts& view, int width, int height, double earthRadiusM,
                            const std::array<BackdropDisc, 2>& discs, bool discsAreDrawn) {
  int block = 16;
  while (std::max(width, height) > block * kMaxBlocks) block *= 2;
  const int columns = (width + block - 1) / block, rows = (height + block - 1) / block;

  // Below it rays meet the ground.
  const double horizon = -std::acos(std::clamp(earthRadiusM / (earthRadiusM + view.eyeM.z), 0.0, 1.0));
  const auto kindAt = [&](int column, int row) {
    const auto clip = [block](int i, int size) { return 2.0 * std::min(i * block, size) / size - 1.0; };
    const Cone cone =
        coneOf(view, clip(column, width), clip(row, height), clip(column + 1, width), clip(row + 1, height));
    const double elevation = std::asin(std::clamp(cone.axis.z, -1.0, 1.0));
    if (elevation + cone.angle < horizon) return BackdropKind::kGround;
    if (elevation - cone.angle <= horizon) return BackdropKind::kAll;
    for (const BackdropDisc& disc : discs)
      // With the edge that lib/background.glsl gives it.
      if (discsAreDrawn && angleBetween(cone.axis, glm::dvec3(disc.direction)) <
                               cone.angle + disc.radiusRad + 2.0 * view.pixelRad)
        return BackdropKind::kAll;
    return BackdropKind::kSky;
  };

  BackdropTiles out;
  const BackdropTiles whole{{BackdropTile{BackdropKind::kAll, 0, 0, width, height}}, 1};
  int before = 0;  // the tiles of the row below
  for (int row = 0; row < rows; ++row) {
    const int first = out.count, y = row * block, tall = std::min(block, height - y);
    for (int column = 0; column < columns;) {
      const BackdropKind kind = kindAt(column, row);
      int end = column + 1;
      while (end < columns && kindAt(end, row) == kind) ++end;
      if (out.count == BackdropTiles::kMax) return whole;
      const int x = column * block;
      out.tiles[static_cast<std::size_t>(out.count++)] = {kind, x, y, std::min(end * block, width) - x, tall};
      column = end;
    }
    // A row like the one below makes that one taller.
    const int count = out.count - first;
    bool same = first - before == count;
    for (int i = 0; same && i < count; ++i) {
      const BackdropTile& a = out.tiles[static_cast<std::size_t>(before + i)];
      const BackdropTile& b = out.tiles[static_cast<std::size_t>(first + i)];
      same = a.kind == b.kind && a.x == b.x && a.width == b.width;
    }
    if (same) {
      for (int i = 0; i < count; ++i) out.tiles[static_cast<std::size_t>(before + i)].height += tall;
      out.count = first;
    } else {
      before = first;
    }
  }
  return out;
}

}  // namespace welkin::shading
