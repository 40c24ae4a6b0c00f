// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/milky_way.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "welkin/core/units.h"
#include "welkin/sky/stars.h"

namespace welkin::sky {
namespace {

constexpr int kColumns = 180, kRows = 49;
constexpr short kPoints[kRows * kColumns] = {
#include "welkin/sky/milky_way.inc"
};

// Texels a step of the table, so that linear filtering shows no edges between them.
constexpr int kFiner = 4;

// Weights of four control points of a uniform cubic B-spline.
std::array<double, 4> weights(double t) {
  const double u = 1.0 - t;
  return {u * u * u / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
          (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0, t * t * t / 6.0};
}

Image<float> makeMap() {
  const double unit = starIlluminanceLux(10.0) / (radians(1.0) * radians(1.0));  // S10
  const glm::vec3 colour = blackBodyColour(starTemperatureK(0.78));
  // Texels' middles: columns repeat, rows are clamped and reach half a texel beyond the last points.
  Image<float> map(kColumns * kFiner, (kRows - 1) * kFiner, 3);
  for (int y = 0; y < map.height; ++y) {
    const double atY = (y + 0.5) / kFiner;
    const int y0 = static_cast<int>(atY);
    const std::array<double, 4> wy = weights(atY - y0);
    for (int x = 0; x < map.width; ++x) {
      const double atX = (x + 0.5) / kFiner;
      const int x0 = static_cast<int>(atX);
      const std::array<double, 4> wx = weights(atX - x0);
      double sum = 0.0;
      for (int j = 0; j < 4; ++j) {
        const int row = std::clamp(y0 - 1 + j, 0, kRows - 1);
        for (int i = 0; i < 4; ++i)
          sum += wy[static_cast<std::size_t>(j)] * wx[static_cast<std::size_t>(i)] *
                 kPoints[row * kColumns + (x0 - 1 + i + kColumns) % kColumns];
      }
      for (int c = 0; c < 3; ++c) map.at(x, y, c) = static_cast<float>(sum * unit) * colour[c];
    }
  }
  return map;
}

}  // namespace

const Image<float>& milkyWay() {
  static const Image<float> map = makeMap();
  return map;
}

float milkyWayShare(double sunElevationDeg) {
  const double x = std::clamp((-6.0 - sunElevationDeg) / 4.0, 0.0, 1.0);
  return static_cast<float>(x * x * (3.0 - 2.0 * x));
}

}  // namespace welkin::sky
