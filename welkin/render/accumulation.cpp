// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/accumulation.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/colour.h"
#include "welkin/core/parallel.h"

namespace welkin::render {
namespace {

constexpr int kTilePx = 32;
constexpr int kResolveRadius = 2;

bool isUnfinished(const Image<float>& first, const Image<float>& both, int x0, int y0, float tolerance) {
  const int x1 = std::min(x0 + kTilePx, first.width), y1 = std::min(y0 + kTilePx, first.height);
  float sum = 0.0f, largest = 0.0f;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const float a = luminanceOf(&first.data[first.index(x, y)]);
      const float total = luminanceOf(&both.data[both.index(x, y)]);
      const float difference = std::abs(total - 2.0f * a) / std::max(total, 1e-12f);
      sum += difference;
      largest = std::max(largest, difference);
    }
  return sum > tolerance * static_cast<float>((x1 - x0) * (y1 - y0)) || largest > 4.0f * tolerance;
}

}  // namespace

std::vector<gpu::Tile> unfinishedTiles(const Image<float>& first, const Image<float>& both, float tolerance) {
  const int columns = (first.width + kTilePx - 1) / kTilePx, rows = (first.height + kTilePx - 1) / kTilePx;
  std::vector<char> unfinished(static_cast<std::size_t>(columns) * rows);
  parallelFor(unfinished.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      unfinished[i] = isUnfinished(first, both, static_cast<int>(i) % columns * kTilePx,
                                   static_cast<int>(i) / columns * kTilePx, tolerance);
  });

  std::vector<gpu::Tile> tiles;
  for (int row = 0; row < rows; ++row) {
    const int top = row * kTilePx, bottom = std::min(top + kTilePx, first.height);
    for (int column = 0; column < columns; ++column) {
      if (!unfinished[static_cast<std::size_t>(row) * columns + column]) continue;
      const int left = column * kTilePx;
      while (column + 1 < columns && unfinished[static_cast<std::size_t>(row) * columns + column + 1])
        ++column;
      tiles.push_back(
          {left, first.height - bottom, std::min((column + 1) * kTilePx, first.width) - left, bottom - top});
    }
  }
  return tiles;
}

Image<float> resolve(const Image<float>& sums, float noise) {
  const int width = sums.width, height = sums.height;
  Image<float> mean(width, height, 3), picture(width, height, 3);
  parallelFor(static_cast<std::size_t>(width) * height, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < 3; ++c) mean.data[3 * i + c] = sums.data[4 * i + c] / sums.data[4 * i + 3];
  });
  const float reach = 1.0f / (3.0f * noise);
  parallelFor(height, 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x) {
        const float* centre = &mean.data[mean.index(x, y)];
        const float own = luminanceOf(centre);
        float rgb[3] = {0.0f, 0.0f, 0.0f}, weights = 0.0f;
        for (int v = std::max(y - kResolveRadius, 0); v <= std::min(y + kResolveRadius, height - 1); ++v)
          for (int u = std::max(x - kResolveRadius, 0); u <= std::min(x + kResolveRadius, width - 1); ++u) {
            const float* p = &mean.data[mean.index(u, v)];
            const float other = luminanceOf(p);
            const float d = (other - own) / std::max(other + own, 1e-12f) * reach;
            const float near = std::max(1.0f - d * d, 0.0f);
            const float w = near * near;
            for (int c = 0; c < 3; ++c) rgb[c] += w * p[c];
            weights += w;
          }
        for (int c = 0; c < 3; ++c) picture.at(x, y, c) = rgb[c] / weights;
      }
  });
  return picture;
}

}  // namespace welkin::render
