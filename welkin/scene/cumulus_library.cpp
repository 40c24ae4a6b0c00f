// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cumulus_library.h"

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "welkin/field/cloud_map.h"
#include "welkin/field/cumulus_tower.h"
#include "welkin/fit/fit_metaballs.h"

namespace welkin::scene {
namespace {

constexpr int kShapes = 4;
constexpr std::array<std::size_t, kLibraryLevels> kBalls = {12, 60, 240};
constexpr double kWidthM = 1200.0, kVoxelM = 40.0;
constexpr double kEffort = 0.4;
constexpr int kBelow = 6;  // voxels of clear air under the base, so that balls do not bulge out of it

// The mean square of the distance from the centre in a ball of radius 1.
constexpr double kMeanSquare =
    (1.0 / 5 - 22.0 / 63 + 17.0 / 81 - 4.0 / 99) / (1.0 / 3 - 22.0 / 45 + 17.0 / 63 - 4.0 / 81);

// With the mass, the middle and the mean square of the distance from it of all of them.
field::Metaball inOne(const std::vector<field::Metaball>& balls) {
  const double mass = field::integralOf(balls);
  const auto share = [&](const field::Metaball& b) {
    return b.density * field::kWyvillIntegral * b.radiusM * b.radiusM * b.radiusM / mass;
  };
  field::Metaball one;
  for (const field::Metaball& b : balls) one.centreM += share(b) * b.centreM;
  double square = 0.0;
  for (const field::Metaball& b : balls) {
    const glm::dvec3 away = b.centreM - one.centreM;
    square += share(b) * (glm::dot(away, away) + kMeanSquare * b.radiusM * b.radiusM);
  }
  one.radiusM = std::sqrt(square / kMeanSquare);
  one.density = mass / (field::kWyvillIntegral * one.radiusM * one.radiusM * one.radiusM);
  return one;
}

LibraryCloud made(double heightM, std::int64_t seed) {
  field::CumulusParams tower;
  tower.seed = seed;
  tower.widthM = kWidthM;
  tower.heightM = heightM;
  tower.bubbles = 6;
  const std::vector<field::Ellipsoid> bubbles = field::cumulusTower(tower);
  const field::CloudMapParams params = field::cumulusMap(tower, kVoxelM);
  Volume<float> map = field::cloudMap(params, bubbles);
  map.nz += kBelow;
  map.data.insert(map.data.begin(), static_cast<std::size_t>(kBelow * map.nx * map.ny), 0.0f);
  field::VoxelFrame frame{map.nx, map.ny, map.nz, glm::dvec3(params.voxelM), field::firstVoxelM(params)};
  frame.firstVoxelM.z -= kBelow * params.voxelM;
  std::vector<fit::FitLevel> levels;
  levels.reserve(kBalls.size());
  for (const std::size_t count : kBalls) levels.push_back({.count = count, .balls = {}});
  fit::FitParams how;
  how.seed = seed;
  how.effort = kEffort;
  fit::fitMetaballs(map, frame, how, levels);
  // The map's mean where there is cloud.
  double sum = 0.0;
  std::size_t cloudy = 0;
  for (const float d : map.data) sum += d, cloudy += d > 0.0f ? 1 : 0;
  const double mean = sum / static_cast<double>(cloudy);
  LibraryCloud cloud;
  cloud.height = heightM / kWidthM;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    cloud.levels[i] = std::move(levels[i].balls);
    for (field::Metaball& b : cloud.levels[i]) {
      b.centreM /= kWidthM;
      b.radiusM /= kWidthM;
      b.density /= mean;
    }
    cloud.radii[i] = field::medianRadiusOf(cloud.levels[i]);
  }
  cloud.whole = {inOne(cloud.levels[0])};
  return cloud;
}

std::vector<LibraryCloud> family(double heightM, std::int64_t firstSeed) {
  std::vector<LibraryCloud> clouds;
  clouds.reserve(kShapes);
  for (int i = 0; i < kShapes; ++i) clouds.push_back(made(heightM, firstSeed + i));
  return clouds;
}

}  // namespace

const std::vector<LibraryCloud>& cumulusTowers() {
  static const std::vector<LibraryCloud> kTowers = family(0.8 * kWidthM, 1);
  return kTowers;
}

const std::vector<LibraryCloud>& flatCumulus() {
  static const std::vector<LibraryCloud> kFlat = family(0.45 * kWidthM, 101);
  return kFlat;
}

}  // namespace welkin::scene
