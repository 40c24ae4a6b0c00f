// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/accumulation.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/colour.h"
#include "welkin/core/parallel.h"

namespace welkin::render {
namespace {

constexpr int kBlockPx = 4;
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

// Blocks in which the mean of a measure exceeds the tolerance, or the measure `anywhere` times the tolerance.
template <class Measure>
Image<std::uint8_t> blocksOver(int width, int height, float tolerance, float anywhere,
                               const Measure& measure) {
  Image<std::uint8_t> over(width, height, 1);
  parallelFor((height + kBlockPx - 1) / kBlockPx, 4, [&](std::size_t begin, std::size_t end) {
    for (int y0 = static_cast<int>(begin) * kBlockPx; y0 < static_cast<int>(end) * kBlockPx; y0 += kBlockPx)
      for (int x0 = 0; x0 < width; x0 += kBlockPx) {
        const int x1 = std::min(x0 + kBlockPx, width), y1 = std::min(y0 + kBlockPx, height);
        float sum = 0.0f, largest = 0.0f;
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x) {
            const float m = measure(x, y);
            sum += m;
            largest = std::max(largest, m);
          }
        if (sum <= tolerance * static_cast<float>((x1 - x0) * (y1 - y0)) && largest <= anywhere * tolerance)
          continue;
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x) over.at(x, y) = 1;
      }
  });
  return over;
}

}  // namespace

Image<std::uint8_t> roughBlocks(const Image<float>& first, float tolerance) {
  return blocksOver(first.width, first.height, tolerance, 4.0f,
                    [&](int x, int y) { return roughness(first, x, y); });
}

Image<std::uint8_t> unsettledBlocks(const Image<float>& before, const Image<float>& sums, float tolerance) {
  // Mean luminance of both halves; pixels that have got none in between count as agreeing.
  const int width = sums.width, height = sums.height;
  Image<float> halves(width, height, 2);
  parallelFor(static_cast<std::size_t>(width) * height, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float *a = &before.data[4 * i], *both = &sums.data[4 * i];
      const float later[3] = {both[0] - a[0], both[1] - a[1], both[2] - a[2]}, count = both[3] - a[3];
      const float first = luminanceOf(a) / a[3];
      halves.data[2 * i] = first;
      halves.data[2 * i + 1] = count > 0.0f ? luminanceOf(later) / count : first;
    }
  });
  return blocksOver(width, height, tolerance, 2.0f, [&](int x, int y) {
    if (sums.at(x, y, 3) == before.at(x, y, 3)) return 0.0f;
    float first = 0.0f, second = 0.0f;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
        first += halves.at(u, v, 0);
        second += halves.at(u, v, 1);
      }
    return std::abs(second - first) / std::max(first + second, 1e-12f);
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
