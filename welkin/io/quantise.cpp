// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/quantise.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"

namespace welkin::io {
namespace {

constexpr std::size_t kRowsAtOnce = 16;

// Interleaved gradient noise, in [0, 1). In double so that large pictures keep the pattern.
float gradientNoise(int x, int y) {
  const double inner = 0.06711056 * x + 0.00583715 * y;
  const double outer = 52.9829189 * (inner - std::floor(inner));
  return static_cast<float>(outer - std::floor(outer));
}

}  // namespace

void requireFinite(const Image<float>& image) {
  // One pass without a branch a value, for the usual case that all is well: x * 0 is 0 or NaN.
  float sum = 0.0f;
  for (const float x : image.data) sum += x * 0.0f;
  if (sum == 0.0f) return;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < image.channels; ++c)
        if (const float v = image.at(x, y, c); !std::isfinite(v))
          throw ParameterError("the picture has " +
                               std::string(std::isnan(v) ? "no number" : "an infinite value") +
                               " at pixel (" + std::to_string(x) + ", " + std::to_string(y) + "), channel " +
                               std::to_string(c));
}

Image<std::uint8_t> quantise8(const Image<float>& image) {
  requireFinite(image);
  Image<std::uint8_t> out(image.width, image.height, image.channels);
  parallelFor(static_cast<std::size_t>(image.height), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < image.width; ++x) {
        // Held away from 0 and 1, so that rounding errors of exact multiples do not tip over.
        const float threshold = 0.001f + 0.998f * gradientNoise(x, y);
        for (int c = 0; c < image.channels; ++c)
          out.at(x, y, c) =
              static_cast<std::uint8_t>(std::clamp(image.at(x, y, c), 0.0f, 1.0f) * 255.0f + threshold);
      }
  });
  return out;
}

Image<std::uint16_t> quantise16(const Image<float>& image) {
  requireFinite(image);
  Image<std::uint16_t> out(image.width, image.height, image.channels);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    out.data[i] = static_cast<std::uint16_t>(std::lround(std::clamp(image.data[i], 0.0f, 1.0f) * 65535.0f));
  return out;
}

}  // namespace welkin::io
