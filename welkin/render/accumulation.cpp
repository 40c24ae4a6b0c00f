// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/accumulation.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/colour.h"
#include "welkin/core/parallel.h"

namespace welkin::render {
namespace {

constexpr int kTilePx = 16;
constexpr int kResolveRadius = 2;

// How far the luminance at (x, y) is from the line through its neighbours, relative to theirs: zero in flat
// areas and in gradients, however steep.
float roughness(const Image<float>& sums, int x, int y) {
  auto luminance = [&](int u, int v) {
    const float* p = &sums.data[sums.index(u, v)];
    return luminanceOf(p) / p[3];
  };
  const float own = 2.0f * luminance(x, y);
  float largest = 0.0f;
  auto compare = [&](float sum) {
    largest = std::max(largest, std::abs(sum - own) / std::max(sum + own, 1e-12f));
  };
  if (x > 0 && x + 1 < sums.width) compare(luminance(x - 1, y) + luminance(x + 1, y));
  if (y > 0 && y + 1 < sums.height) compare(luminance(x, y - 1) + luminance(x, y + 1));
  return largest;
}

// Does any measure of a pixel of the tile exceed `anywhere` times the tolerance, or their mean the tolerance?
template <class Measure>
bool exceeds(const Image<float>& size, int x0, int y0, float tolerance, float anywhere,
             const Measure& measure) {
  const int x1 = std::min(x0 + kTilePx, size.width), y1 = std::min(y0 + kTilePx, size.height);
  float sum = 0.0f, largest = 0.0f;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const float m = measure(x, y);
      sum += m;
      largest = std::max(largest, m);
    }
  return sum > tolerance * static_cast<float>((x1 - x0) * (y1 - y0)) || largest > anywhere * tolerance;
}

// The tiles for which `wanted(x0, y0)`, merged along rows.
template <class Wanted>
std::vector<gpu::Tile> tilesWhere(int width, int height, const Wanted& wanted) {
  const int columns = (width + kTilePx - 1) / kTilePx, rows = (height + kTilePx - 1) / kTilePx;
  std::vector<char> chosen(static_cast<std::size_t>(columns) * rows);
  parallelFor(chosen.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      chosen[i] = wanted(static_cast<int>(i) % columns * kTilePx, static_cast<int>(i) / columns * kTilePx);
  });

  std::vector<gpu::Tile> tiles;
  for (int row = 0; row < rows; ++row) {
    const int top = row * kTilePx, bottom = std::min(top + kTilePx, height);
    for (int column = 0; column < columns; ++column) {
      if (!chosen[static_cast<std::size_t>(row) * columns + column]) continue;
      const int left = column * kTilePx;
      while (column + 1 < columns && chosen[static_cast<std::size_t>(row) * columns + column + 1]) ++column;
      tiles.push_back({left, height - bottom, std::min((column + 1) * kTilePx, width) - left, bottom - top});
    }
  }
  return tiles;
}

}  // namespace

std::vector<gpu::Tile> roughTiles(const Image<float>& first, float tolerance) {
  return tilesWhere(first.width, first.height, [&](int x0, int y0) {
    return exceeds(first, x0, y0, tolerance, 4.0f, [&](int x, int y) { return roughness(first, x, y); });
  });
}

std::vector<gpu::Tile> unsettledTiles(const Image<float>& before, const Image<float>& sums, float tolerance) {
  return tilesWhere(sums.width, sums.height, [&](int x0, int y0) {
    return exceeds(sums, x0, y0, tolerance, 2.0f, [&](int x, int y) {
      // Of three by three pixels, as the resolve takes the dither out.
      float first = 0.0f, second = 0.0f;
      for (int v = std::max(y - 1, y0); v <= std::min({y + 1, y0 + kTilePx - 1, sums.height - 1}); ++v)
        for (int u = std::max(x - 1, x0); u <= std::min({x + 1, x0 + kTilePx - 1, sums.width - 1}); ++u) {
          const float* a = &before.data[before.index(u, v)];
          const float* both = &sums.data[sums.index(u, v)];
          const float later[3] = {both[0] - a[0], both[1] - a[1], both[2] - a[2]}, count = both[3] - a[3];
          if (count <= 0.0f) return 0.0f;
          first += luminanceOf(a) / a[3];
          second += luminanceOf(later) / count;
        }
      return std::abs(second - first) / std::max(first + second, 1e-12f);
    });
  });
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
