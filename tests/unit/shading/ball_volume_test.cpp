// SPDX-License-Identifier: Apache-2.0
// The textures of metaballs that are marched: they hold the field, and the table finds every cloud.
#include "welkin/shading/ball_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/testing/metaball_scene.h"
#include "welkin/core/random.h"
#include "welkin/scene/cumulus_library.h"

namespace welkin::shading {
namespace {

// Linear between the points of a shape's grid, as lib/ball_volume.glsl reads it; own: -1 to 1 in its box.
glm::dvec2 sampled(const BallVolume& v, int column, int row, const glm::dvec3& own) {
  const glm::dvec3 at = (0.5 * own + 0.5) * (v.sidePoints - 1.0);
  const glm::ivec3 i = glm::min(glm::ivec3(at), v.sidePoints - 2);
  const glm::dvec3 w = at - glm::dvec3(i);
  glm::dvec2 sum(0.0);
  for (int k = 0; k < 8; ++k) {
    const glm::ivec3 o(k & 1, k >> 1 & 1, k >> 2);
    const double share = (o.x ? w.x : 1.0 - w.x) * (o.y ? w.y : 1.0 - w.y) * (o.z ? w.z : 1.0 - w.z);
    for (int c = 0; c < 2; ++c)
      sum[c] += share * static_cast<double>(v.shapes.at(column * v.sidePoints + i.x + o.x,
                                                        row * v.sidePoints + i.y + o.y, i.z + o.z, c));
  }
  return sum;
}

glm::vec4 texel(const BallVolume& v, std::size_t i) {
  return {v.table.data[4 * i], v.table.data[4 * i + 1], v.table.data[4 * i + 2], v.table.data[4 * i + 3]};
}

template <class T>
T uniform(const BallVolume& v, std::string_view name) {
  const auto found =
      std::ranges::find(v.uniforms, name, [](const auto& u) { return std::string_view(u.first); });
  return std::get<T>(found->second);
}

// Extinction and a clearance at a place, as lib/ball_volume.glsl finds them.
struct Found {
  double extinction = 0.0, clearM = 1e9;
};
Found at(const BallVolume& v, const glm::dvec3& q) {
  Found found;
  const glm::dvec4 grid(uniform<glm::vec4>(v, "uBallGrid"));
  const glm::dvec2 cells(uniform<glm::vec2>(v, "uBallCells"));
  const glm::dvec2 where = (glm::dvec2(q) - glm::dvec2(grid)) / grid.z;
  if (!(where.x >= 0.0 && where.y >= 0.0 && where.x < cells.x && where.y < cells.y)) return found;
  const glm::vec4 cell =
      texel(v, static_cast<std::size_t>(std::floor(where.y) * cells.x + std::floor(where.x)));
  if (cell.y == 0.0f) found.clearM = static_cast<double>(cell.z);
  for (std::size_t i = 0; i < static_cast<std::size_t>(cell.y); ++i) {
    const std::size_t first = static_cast<std::size_t>(cell.x) + 3 * i;
    const glm::dvec4 place(texel(v, first)), turn(texel(v, first + 1)), size(texel(v, first + 2));
    const glm::dvec3 d = q - glm::dvec3(place);
    const glm::dvec3 own =
        glm::dvec3(turn.x * d.x - turn.y * d.y, turn.y * d.x + turn.x * d.y, d.z) * glm::dvec3(size);
    if (std::max({std::abs(own.x), std::abs(own.y), std::abs(own.z)}) > 1.0) continue;
    const glm::dvec2 there = sampled(v, static_cast<int>(turn.z), static_cast<int>(turn.w), own);
    found.extinction += place.w * there.x;
    if (there.x == 0.0) found.clearM = std::min(found.clearM, there.y / size.z);
  }
  return found;
}

TEST(BallVolume, HoldsTheFieldOfTheLibrarysClouds) {
  scene::MetaballInstances all;
  for (const auto* family : {&scene::cumulusTowers(), &scene::flatCumulus()})
    for (const scene::LibraryCloud& cloud : *family) {
      const std::vector<field::Metaball>& balls = cloud.levels.back();
      all.balls.insert(all.balls.end(), balls.begin(), balls.end());
      all.instances.push_back({all.shapes.size(), {0.0, 0.0, 1000.0}, 1000.0, 0.0, 0.05});
      all.shapes.push_back({all.balls.size(), field::boundsOf(balls)});
    }
  const BallVolume v = ballVolume(all);
  ASSERT_FALSE(v.empty());
  Random random(1);
  const int columns = static_cast<int>(uniform<glm::vec3>(v, "uBallTiles").y);
  for (std::size_t i = 0; i < all.shapes.size(); ++i) {
    const std::span<const field::Metaball> balls = all.ballsOf(i);
    const field::MetaballField field(std::vector<field::Metaball>(balls.begin(), balls.end()));
    const field::Box& box = all.shapes[i].box;
    double error = 0.0, whole = 0.0;
    int clear = 0;
    for (int k = 0; k < 20000; ++k) {
      const glm::dvec3 own(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0,
                           2.0 * random.uniform() - 1.0);
      const glm::dvec3 p = box.low + (0.5 * own + 0.5) * (box.high - box.low);
      const double truth = std::max(field(p), 0.0);
      const glm::dvec2 found = sampled(v, static_cast<int>(i) % columns, static_cast<int>(i) / columns, own);
      error += (found.x - truth) * (found.x - truth);
      whole += truth * truth;
      if (found.x > 0.0) continue;
      // Clear as far as it says.
      double nearest = 1e9;
      for (const field::Metaball& b : balls)
        nearest = std::min(nearest, glm::length(p - b.centreM) - b.radiusM);
      ASSERT_LE(found.y * 0.5 * (box.high.z - box.low.z), std::max(nearest, 0.0) + 0.02);
      clear += found.y > 0.0 ? 1 : 0;
    }
    EXPECT_LT(std::sqrt(error / whole), 0.03) << "shape " << i;
    EXPECT_GT(clear, 500) << "shape " << i;
  }
}

// Turned, sized, overlapping, near and far: at any place what the table finds is what stands there.
TEST(BallVolume, TheTableFindsEveryCloud) {
  scene::MetaballInstances all;
  std::vector<field::MetaballField> fields;
  for (const int count : {60, 150}) {
    std::vector<field::Metaball> balls = testing::lumpOfBalls(count, 1.0);
    for (field::Metaball& b : balls) b.centreM.x *= 1.0 + 0.005 * count;
    all.balls.insert(all.balls.end(), balls.begin(), balls.end());
    all.shapes.push_back({all.balls.size(), field::boundsOf(balls)});
    fields.emplace_back(balls);
  }
  Random random(4);
  for (int i = 0; i < 300; ++i)
    all.instances.push_back({static_cast<std::size_t>(i % 2),
                             {30000.0 * random.uniform() - 15000.0, 20000.0 * random.uniform() - 10000.0,
                              1500.0 + 500.0 * random.uniform()},
                             0.3 + random.uniform(),
                             6.28 * random.uniform(),
                             0.02 * random.uniform()});
  const BallVolume v = ballVolume(all);
  double error = 0.0, whole = 0.0;
  int cloudy = 0;
  for (int k = 0; k < 20000; ++k) {
    const glm::dvec3 q(32000.0 * random.uniform() - 16000.0, 22000.0 * random.uniform() - 11000.0,
                       600.0 + 2400.0 * random.uniform());
    double truth = 0.0, nearestM = 1e9;
    for (const auto& cloud : all.instances) {
      const glm::dvec3 d = (q - cloud.positionM) / cloud.scale;
      const double c = std::cos(cloud.turnRad), s = std::sin(cloud.turnRad);
      const glm::dvec3 p(c * d.x - s * d.y, s * d.x + c * d.y, d.z);
      truth += cloud.extinctionPerM * fields[cloud.shape](p);
      nearestM = std::min(nearestM, cloud.scale * (glm::length(p) - 1200.0));
    }
    const Found found = at(v, q);
    error += (found.extinction - truth) * (found.extinction - truth);
    whole += truth * truth;
    if (truth > 0.0) {
      ++cloudy;
      EXPECT_GE(q.z, v.lowM);
      EXPECT_LE(q.z, v.highM);
    } else if (nearestM > 3000.0) {
      EXPECT_GT(found.clearM, 500.0);  // far from all of them, far can be stepped
    }
  }
  EXPECT_GT(cloudy, 1000);
  EXPECT_LT(std::sqrt(error / whole), 0.02);
}

TEST(BallVolume, NoCloudsNoTextures) {
  EXPECT_TRUE(ballVolume({}).empty());
}

}  // namespace
}  // namespace welkin::shading
