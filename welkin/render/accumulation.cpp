// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/accumulation.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/colour.h"
#include "welkin/core/parallel.h"

namespace welkin::render {
namespace {

constexpr int kBlockPx = 4;
constexpr float kOpaque = 0.98f;  // hides all that is behind
constexpr int kResolveRadius = 2;

// How far the luminance at (x, y) is from the line through its neighbours, relative to theirs: zero in flat
// areas and in gradients, however steep. Only pixels that are drawn count.
float roughness(const Image<float>& sums, int x, int y) {
  auto weight = [&](int u, int v) { return sums.at(u, v, 3); };
  auto luminance = [&](int u, int v) { return luminanceOf(&sums.data[sums.index(u, v)]) / weight(u, v); };
  if (weight(x, y) == 0.0f) return 0.0f;
  const float own = 2.0f * luminance(x, y);
  float largest = 0.0f;
  auto compare = [&](int u, int v) {
    if (x < u || y < v || x + u >= sums.width || y + v >= sums.height) return;
    if (weight(x - u, y - v) == 0.0f || weight(x + u, y + v) == 0.0f) return;
    const float sum = luminance(x - u, y - v) + luminance(x + u, y + v);
    largest = std::max(largest, std::abs(sum - own) / std::max(sum + own, 1e-12f));
  };
  compare(1, 0);
  compare(0, 1);
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

// Means of the blocks of a half. Those cut by the border are none of them.
class BlockMeans {
 public:
  explicit BlockMeans(const Image<float>& half) : means_(half.width / kBlockPx, half.height / kBlockPx, 4) {
    parallelFor(static_cast<std::size_t>(means_.height), 4, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
        for (int x = 0; x < means_.width; ++x) {
          float* mean = &means_.data[means_.index(x, y)];
          for (int v = 0; v < kBlockPx; ++v)
            for (int u = 0; u < kBlockPx; ++u) {
              const float* p = &half.data[half.index(kBlockPx * x + u, kBlockPx * y + v)];
              for (int c = 0; c < 4; ++c) mean[c] += p[c] / (kBlockPx * kBlockPx);
            }
        }
    });
  }

  int width() const { return means_.width; }
  int height() const { return means_.height; }
  // Whether a block has drawn ones on all sides, and next to these.
  bool surrounded(int x, int y) const {
    if (x < 3 || y < 3 || x + 3 >= width() || y + 3 >= height()) return false;
    for (const int d : {-3, -1, 1, 3})
      if (at(x + d, y)[3] == 0.0f || at(x, y + d)[3] == 0.0f) return false;
    return true;
  }
  const float* at(int x, int y) const { return &means_.data[means_.index(x, y)]; }

  // A channel's value in the middle of a block by the line through those beside it, and by the curve through
  // four.
  struct Guess {
    float line, curve;
  };
  template <class ValueAt>  // by distance along an axis
  static Guess guess(const ValueAt& at) {
    const float near = at(-1) + at(1);
    return {0.5f * near, (9.0f * near - at(-3) - at(3)) / 16.0f};
  }

 private:
  Image<float> means_;
};

// Columns [from, from + count) of a picture that goes around.
template <class Value>
Image<Value> columnsOf(const Image<Value>& picture, int from, int count) {
  Image<Value> piece(count, picture.height, picture.channels);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < count; ++x) {
      const int at = ((from + x) % picture.width + picture.width) % picture.width;
      std::copy_n(&picture.data[picture.index(at, y)], picture.channels, &piece.data[piece.index(x, y)]);
    }
  return piece;
}

// Writes columns [skipped, skipped + count) of a piece to where they belong.
template <class Value>
void putColumns(const Image<Value>& piece, int skipped, int count, Image<Value>& picture, int to) {
  for (int y = 0; y < piece.height; ++y)
    std::copy_n(&piece.data[piece.index(skipped, y)], static_cast<std::size_t>(count) * piece.channels,
                &picture.data[picture.index(to, y)]);
}

// What a function of plane pictures gives for those of another form: for each face, or with the columns
// beyond its edges.
template <class Function, class... Value>
auto byForm(Form form, const Function& function, const Image<Value>&... pictures) {
  const int width = std::max({pictures.width...}), height = std::max({pictures.height...});
  const int pieces = form == Form::kSixFaces ? 6 : 1, count = width / pieces;
  const int beyond = form == Form::kAround ? kBlockPx : 0;
  decltype(function(pictures...)) all;
  for (int x = 0; x < pieces * count; x += count) {
    const auto piece = function(columnsOf(pictures, x - beyond, count + 2 * beyond)...);
    if (x == 0) all = {width, height, piece.channels};
    putColumns(piece, beyond, count, all, x);
  }
  return all;
}

}  // namespace

Form formOf(scene::Projection projection) {
  switch (projection) {
    case scene::Projection::kEquirect:
      return Form::kAround;
    case scene::Projection::kCubemap:
      return Form::kSixFaces;
    default:
      return Form::kPlane;
  }
}

Image<std::uint8_t> firstHalf(int width, int height, Form form) {
  if (form == Form::kSixFaces)
    return byForm(
        form, [](const auto& face) { return firstHalf(face.width, face.height); },
        Image<std::uint8_t>(width, height, 1));
  Image<std::uint8_t> half(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) half.at(x, y) = (x / kBlockPx + y / kBlockPx) % 2 == 0 ? 1 : 0;
  return half;
}

Image<std::uint8_t> secondHalf(const Image<float>& half, const Image<float>& hidden, float tolerance,
                               Form form) {
  // Nothing is told at an edge, around or not.
  if (form == Form::kSixFaces)
    return byForm(
        form, [&](const auto& h, const auto& over) { return secondHalf(h, over, tolerance); }, half, hidden);
  const BlockMeans means(half);
  Image<std::uint8_t> wanted(half.width, half.height, 1);
  const Image<std::uint8_t> rough = roughBlocks(half, tolerance);
  const auto plain = [&](int x, int y) {
    if (rough.at(kBlockPx * x, kBlockPx * y) == 1) return false;
    for (int v = 0; v < kBlockPx; ++v)
      for (int u = 0; u < kBlockPx; ++u)
        if (hidden.at(kBlockPx * x + u, kBlockPx * y + v) < kOpaque) return false;
    return true;
  };
  const auto canBeTold = [&](int x, int y) {
    if (!means.surrounded(x, y)) return false;
    if (!plain(x - 1, y) || !plain(x + 1, y) || !plain(x, y - 1) || !plain(x, y + 1)) return false;
    const auto [a, b] = BlockMeans::guess([&](int d) { return luminanceOf(means.at(x + d, y)); });
    const auto [c, e] = BlockMeans::guess([&](int d) { return luminanceOf(means.at(x, y + d)); });
    const auto [least, most] = std::minmax({a, b, c, e});
    return most - least <= 2.0f * tolerance * std::max(least, 0.0f);
  };
  const int down = (half.height + kBlockPx - 1) / kBlockPx, across = (half.width + kBlockPx - 1) / kBlockPx;
  parallelFor(static_cast<std::size_t>(down), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < across; ++x) {
        const bool drawn = half.at(kBlockPx * x, kBlockPx * y, 3) > 0.0f;
        if (drawn || canBeTold(x, y)) continue;
        for (int v = kBlockPx * y; v < std::min(kBlockPx * (y + 1), half.height); ++v)
          for (int u = kBlockPx * x; u < std::min(kBlockPx * (x + 1), half.width); ++u) wanted.at(u, v) = 1;
      }
  });
  return wanted;
}

Image<std::uint8_t> fillBlocks(Image<float>& first, Form form) {
  if (form == Form::kSixFaces) {
    Image<std::uint8_t> all(first.width, first.height, 1);
    const int side = first.width / 6;
    for (int x = 0; x < 6 * side; x += side) {
      Image<float> face = columnsOf(first, x, side);
      putColumns(fillBlocks(face), 0, side, all, x);
      putColumns(face, 0, side, first, x);
    }
    return all;
  }
  const BlockMeans means(first);
  Image<std::uint8_t> filled(first.width, first.height, 1);
  parallelFor(static_cast<std::size_t>(means.height()), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < means.width(); ++x) {
        if (means.at(x, y)[3] > 0.0f) continue;
        for (int c = 0; c < 3; ++c) {
          const auto along = [&](int d) { return means.at(x + d, y)[c]; };
          const auto across = [&](int d) { return means.at(x, y + d)[c]; };
          const float middle = 0.5f * (BlockMeans::guess(along).curve + BlockMeans::guess(across).curve);
          const float slopeX = (along(1) - along(-1)) / (2 * kBlockPx),
                      slopeY = (across(1) - across(-1)) / (2 * kBlockPx);
          for (int v = 0; v < kBlockPx; ++v)
            for (int u = 0; u < kBlockPx; ++u) {
              const float dx = static_cast<float>(u) - 0.5f * (kBlockPx - 1),
                          dy = static_cast<float>(v) - 0.5f * (kBlockPx - 1);
              first.at(kBlockPx * x + u, kBlockPx * y + v, c) = middle + slopeX * dx + slopeY * dy;
            }
        }
        for (int v = 0; v < kBlockPx; ++v)
          for (int u = 0; u < kBlockPx; ++u) {
            first.at(kBlockPx * x + u, kBlockPx * y + v, 3) = 1.0f;
            filled.at(kBlockPx * x + u, kBlockPx * y + v) = 1;
          }
      }
  });
  return filled;
}

Image<std::uint8_t> roughBlocks(const Image<float>& first, float tolerance, Form form) {
  if (form != Form::kPlane)
    return byForm(form, [&](const auto& piece) { return roughBlocks(piece, tolerance); }, first);
  return blocksOver(first.width, first.height, tolerance, 4.0f,
                    [&](int x, int y) { return roughness(first, x, y); });
}

Image<std::uint8_t> unsettledBlocks(const Image<float>& before, const Image<float>& sums, float tolerance,
                                    Form form) {
  if (form != Form::kPlane)
    return byForm(
        form, [&](const auto& b, const auto& s) { return unsettledBlocks(b, s, tolerance); }, before, sums);
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

Image<float> resolve(const Image<float>& sums, float noise, Form form) {
  if (form != Form::kPlane)
    return byForm(form, [&](const auto& piece) { return resolve(piece, noise); }, sums);
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
