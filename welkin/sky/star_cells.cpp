// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/star_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"

namespace welkin::sky {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/stars.glsl"
}  // namespace shared

constexpr double kFinestPixelRad = shared::kWidestPixelRad / (1 << (kStarLevels - 1));
constexpr double kHaloBelow = 4.5;
using shared::kHaloGrowth, shared::kHaloShare, shared::kSpotPx;

struct Spot {
  glm::dvec3 direction;
  float radiusPx;
  glm::vec3 illuminance;
};

// The cells of a face that a cap of the given radius may touch: x0, y0, x1, y1, the last ones included.
struct CellRange {
  int x0, y0, x1, y1;
};

// Of a cap about `dir`, by the axes of a face: `along` it, `a` and `other` across. The cap's extent in the
// angle atan(a / along) is that of a circle in longitude.
bool extent(double a, double other, double along, double radius, int cells, int& first, int& last) {
  const double sine = std::sin(radius), c = std::sqrt(std::max(1.0 - other * other, 0.0));
  first = 0;
  last = cells - 1;
  if (sine >= c) return true;  // about the pole: all of them
  const double middle = std::atan2(a, along), half = std::asin(sine / c) + 1e-6;
  if (middle + half < -kPi / 4 || middle - half > kPi / 4) return false;
  const auto cellAt = [&](double angle) {
    return std::clamp(
        static_cast<int>(std::floor((std::tan(std::clamp(angle, -0.8, 0.8)) * 0.5 + 0.5) * cells)), 0,
        cells - 1);
  };
  first = cellAt(middle - half);
  last = cellAt(middle + half);
  return true;
}

template <class Each>
void forEachCell(const glm::dvec3& dir, double radius, int cells, const Each& each) {
  // A face's corner is 54.7 degrees from its middle.
  const double farthest = std::cos(std::min(radius + 0.956, kPi));
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double along = face % 2 == 0 ? dir[axis] : -dir[axis];
    if (along < farthest) continue;
    const double a = dir[axis == 0 ? 1 : 0], b = dir[axis == 2 ? 1 : 2];
    CellRange r{};
    if (!extent(a, b, along, radius, cells, r.x0, r.x1) || !extent(b, a, along, radius, cells, r.y0, r.y1))
      continue;
    for (int y = r.y0; y <= r.y1; ++y)
      for (int x = r.x0; x <= r.x1; ++x) each(static_cast<std::size_t>((face * cells + y) * cells + x));
  }
}

}  // namespace

int starLevel(float pixelRad) {
  int level = 0;
  while (level + 1 < kStarLevels && pixelRad > kFinestPixelRad * (1 << level)) ++level;
  return level;
}

float starlightShare(double sunElevationDeg) {
  const double x = std::clamp(1.0 - sunElevationDeg / 3.0, 0.0, 1.0);
  return static_cast<float>(x * x * (3.0 - 2.0 * x));
}

PlanetSpots planetSpots(const Ephemeris& ephemeris, double eyeM, float pixelRad) {
  constexpr double kMarginRad = 0.1;
  constexpr double kByDay = 150.0;  // cd/m2
  const double lowest = -std::sqrt(2.0 * std::max(eyeM, 0.0) / kEarthRadiusM) - kMarginRad;
  const float others = starlightShare(darknessElevationDeg(ephemeris));
  PlanetSpots out;
  for (const Planet& planet : ephemeris.planets) {
    const auto lux = static_cast<float>(starIlluminanceLux(planet.magnitude));
    const auto leastRad = static_cast<float>(2.0 * planet.body.angularRadiusRad);
    const bool byDay = lux * shared::planetShare(glm::vec3(0.0f), 0.0f, leastRad, pixelRad) > kByDay;
    const float share = byDay ? 1.0f : others;
    if (share <= 0.0f || planet.body.direction.z < lowest) continue;
    out.spots[static_cast<std::size_t>(out.count++)] = {
        glm::vec3(planet.body.direction), leastRad,
        share * lux * blackBodyColour(starTemperatureK(planet.colour)),
        static_cast<float>(kHaloBelow - planet.magnitude)};
  }
  return out;
}

StarCells starCells(std::span<const StarLight> stars, int level) {
  const double pixelRad = kFinestPixelRad * (1 << level);
  StarCells out;
  out.cells = std::max(64 >> std::max(level - 1, 0), 4);

  std::vector<Spot> spots;
  spots.reserve(stars.size() + stars.size() / 8);
  for (const StarLight& star : stars) {
    const auto brighter = static_cast<float>(std::max(kHaloBelow - star.magnitude, 0.0));
    // In the beginning of it the halo is faint, so that none begins at once.
    const float halo = kHaloShare * std::min(brighter, 1.0f);
    spots.push_back({star.direction, kSpotPx, (1.0f - halo) * star.illuminance});
    if (halo > 0.0f)
      spots.push_back({star.direction, kSpotPx * (1.0f + kHaloGrowth * brighter), halo * star.illuminance});
  }

  const std::size_t cellCount = 6u * static_cast<std::size_t>(out.cells) * out.cells;
  std::vector<std::uint32_t> counts(cellCount, 0), next(cellCount);
  const auto radiusOf = [&](const Spot& spot) { return spot.radiusPx * pixelRad; };
  for (const Spot& spot : spots)
    forEachCell(spot.direction, radiusOf(spot), out.cells, [&](std::size_t cell) { ++counts[cell]; });
  std::size_t texels = cellCount;
  for (std::size_t i = 0; i < cellCount; ++i) {
    next[i] = static_cast<std::uint32_t>(texels);
    texels += 2 * counts[i];
  }

  constexpr int kWidth = 1 << shared::kStarRowBits;
  out.texels = Image<float>(kWidth, static_cast<int>((texels + kWidth - 1) / kWidth), 4);
  float* data = out.texels.data.data();
  const auto put = [data](std::size_t i, const glm::vec3& v, float w) {
    for (int c = 0; c < 3; ++c) data[4 * i + static_cast<std::size_t>(c)] = v[c];
    data[4 * i + 3] = w;
  };
  for (std::size_t i = 0; i < cellCount; ++i)
    put(i, {static_cast<float>(next[i]), static_cast<float>(counts[i]), 0.0f}, 0.0f);
  for (const Spot& spot : spots)
    forEachCell(spot.direction, radiusOf(spot), out.cells, [&](std::size_t cell) {
      put(next[cell], glm::vec3(spot.direction), spot.radiusPx);
      put(next[cell] + 1, spot.illuminance, 0.0f);
      next[cell] += 2;
    });
  return out;
}

}  // namespace welkin::sky
