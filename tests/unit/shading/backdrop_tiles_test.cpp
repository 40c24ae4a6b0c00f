// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/backdrop_tiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "welkin/core/units.h"

namespace welkin::shading {
namespace {

constexpr int kWidth = 333, kHeight = 190;  // no multiples of anything

ViewParts looking(double heightM, double pitchDeg, double rollDeg, double fovDeg) {
  View view;
  const double pitch = radians(pitchDeg), roll = radians(rollDeg);
  const glm::dvec3 eye(0.0, 0.0, heightM), forward(0.0, std::cos(pitch), std::sin(pitch));
  const glm::dvec3 right(1.0, 0.0, 0.0), up = glm::cross(right, forward);
  view.view = glm::lookAt(eye, eye + forward, up * std::cos(roll) + right * std::sin(roll));
  view.projection = glm::perspective(radians(fovDeg), static_cast<double>(kWidth) / kHeight, 0.1, 1000.0);
  return partsOf(view, kHeight);
}

// What a pixel shows, as lib/background.glsl has it.
BackdropKind kindOf(const ViewParts& view, int x, int y, const BackdropDisc& disc) {
  const double cx = 2.0 * (x + 0.5) / kWidth - 1.0, cy = 2.0 * (y + 0.5) / kHeight - 1.0;
  const glm::dvec3 dir = glm::normalize(
      glm::dmat3(view.enuFromCamera) *
      glm::dvec3(view.rayScale.x * cx + view.rayScale.z, view.rayScale.y * cy + view.rayScale.w, -1.0));
  const double b = (kEarthRadiusM + view.eyeM.z) * dir.z,
               c = view.eyeM.z * (2.0 * kEarthRadiusM + view.eyeM.z);
  if (b < 0.0 && b * b > c) return BackdropKind::kGround;
  const double seen = std::max<double>(disc.radiusRad, 0.75 * view.pixelRad);
  return glm::length(dir - glm::dvec3(disc.direction)) < seen + 0.5 * view.pixelRad ? BackdropKind::kAll
                                                                                    : BackdropKind::kSky;
}

TEST(BackdropTiles, EachPixelIsInOneTileThatShowsIt) {
  const BackdropDisc sun{glm::normalize(glm::vec3(0.1f, 1.0f, 0.15f)), 0.0047f};
  const BackdropDisc moon{glm::vec3(0.0f, 0.0f, -1.0f), 0.0045f};
  for (const double heightM : {2.0, 12000.0})
    for (const double pitchDeg : {-90.0, -20.0, 0.0, 12.0, 60.0, 90.0})
      for (const double rollDeg : {0.0, 25.0, 180.0})
        for (const double fovDeg : {5.0, 60.0, 140.0}) {
          SCOPED_TRACE(std::to_string(heightM) + " m, pitch " + std::to_string(pitchDeg) + ", roll " +
                       std::to_string(rollDeg) + ", field " + std::to_string(fovDeg));
          const ViewParts view = looking(heightM, pitchDeg, rollDeg, fovDeg);
          const BackdropTiles tiles = backdropTiles(view, kWidth, kHeight, kEarthRadiusM, {sun, moon}, true);
          std::vector<int> seen(kWidth * kHeight, 0);
          int wrong = 0;
          for (int i = 0; i < tiles.count; ++i) {
            const BackdropTile& t = tiles.tiles[static_cast<std::size_t>(i)];
            for (int y = t.y; y < t.y + t.height; ++y)
              for (int x = t.x; x < t.x + t.width; ++x) {
                ++seen.at(static_cast<std::size_t>(y * kWidth + x));
                wrong += t.kind != BackdropKind::kAll && kindOf(view, x, y, sun) != t.kind;
              }
          }
          EXPECT_EQ(wrong, 0);
          EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), kWidth * kHeight);
        }
}

TEST(BackdropTiles, MostOfAPictureShowsOneThing) {
  const BackdropDisc sun{glm::normalize(glm::vec3(0.1f, 1.0f, 0.4f)), 0.0047f};
  const ViewParts view = looking(2.0, 12.0, 0.0, 50.0);
  const auto mixed = [&](bool discs) {
    const BackdropTiles tiles = backdropTiles(view, kWidth, kHeight, kEarthRadiusM, {sun, sun}, discs);
    int pixels = 0;
    for (int i = 0; i < tiles.count; ++i) {
      const BackdropTile& t = tiles.tiles[static_cast<std::size_t>(i)];
      if (t.kind == BackdropKind::kAll) pixels += t.width * t.height;
    }
    return pixels;
  };
  EXPECT_LT(mixed(true), kWidth * kHeight / 5);
  EXPECT_LT(mixed(false), mixed(true));  // without the sun only the horizon
  EXPECT_GT(mixed(false), 0);
}

}  // namespace
}  // namespace welkin::shading
