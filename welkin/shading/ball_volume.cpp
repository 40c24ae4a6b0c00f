// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/ball_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "welkin/core/parallel.h"

namespace welkin::shading {
namespace {

constexpr double kPointsInRadius = 5.0;  // grid points in the median radius of a shape's balls
constexpr int kCoarsestSide = 32;
constexpr double kMostPoints = 16e6;  // of all shapes together
constexpr int kCoarse = 4;            // grid points between those at which distances are known
constexpr int kMostCells = 128;       // a side
constexpr double kLeastCellM = 100.0;

int sideFor(const scene::MetaballInstances& clouds) {
  double side = kCoarsestSide;
  for (std::size_t i = 0; i < clouds.shapes.size(); ++i) {
    const std::span<const field::Metaball> balls = clouds.ballsOf(i);
    const glm::dvec3 size = clouds.shapes[i].box.high - clouds.shapes[i].box.low;
    side =
        std::max(side, kPointsInRadius * std::max({size.x, size.y, size.z}) / field::medianRadiusOf(balls));
  }
  const double most = std::cbrt(kMostPoints / static_cast<double>(clouds.shapes.size()));
  return static_cast<int>(std::min({std::ceil(side), most, double{BallVolume::kFinestSide}}));
}

// How far from the surface of the nearest ball, in half heights of the box, from a coarser grid; never more.
Volume<float> clearances(std::span<const field::Metaball> balls, const field::Box& box, int side) {
  const int n = (side - 1 + kCoarse - 1) / kCoarse + 1;
  Volume<float> coarse(n, n, n, 1);
  const glm::dvec3 stepM = (box.high - box.low) / static_cast<double>(side - 1);
  const double inexact = 0.5 * kCoarse * glm::length(stepM), halfM = 0.5 * (box.high.z - box.low.z);
  parallelFor(static_cast<std::size_t>(n), 1, [&](std::size_t first, std::size_t last) {
    for (auto z = static_cast<int>(first); z < static_cast<int>(last); ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
          const glm::dvec3 p = box.low + stepM * (static_cast<double>(kCoarse) * glm::dvec3(x, y, z));
          double nearest = std::numeric_limits<double>::max();
          for (const field::Metaball& b : balls)
            nearest = std::min(nearest, glm::length(p - b.centreM) - b.radiusM);
          coarse.at(x, y, z) = static_cast<float>(std::max(nearest - inexact, 0.0) / halfM);
        }
  });
  Volume<float> fine(side, side, side, 1);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)  // the nearest coarse point is within half a step of it
        fine.at(x, y, z) =
            coarse.at((x + kCoarse / 2) / kCoarse, (y + kCoarse / 2) / kCoarse, (z + kCoarse / 2) / kCoarse);
  return fine;
}

}  // namespace

BallVolume ballVolume(const scene::MetaballInstances& clouds) {
  BallVolume out;
  if (clouds.instances.empty()) return out;
  const int side = out.sidePoints = sideFor(clouds);
  const int count = static_cast<int>(clouds.shapes.size());
  const int columns = static_cast<int>(std::ceil(std::sqrt(count))), rows = (count + columns - 1) / columns;
  out.shapes = Volume<float>(columns * side, rows * side, side, 2);
  for (int i = 0; i < count; ++i) {
    const auto shape = static_cast<std::size_t>(i);
    const field::Box& box = clouds.shapes[shape].box;
    const std::span<const field::Metaball> balls = clouds.ballsOf(shape);
    // The outermost points lie on the box, where there is nothing.
    const Volume<float> density = field::rasterise(
        balls, {side, side, side, (box.high - box.low) / static_cast<double>(side - 1), box.low});
    const Volume<float> clear = clearances(balls, box, side);
    const int x0 = i % columns * side, y0 = i / columns * side;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          out.shapes.at(x0 + x, y0 + y, z, 0) = std::max(density.at(x, y, z), 0.0f);
          out.shapes.at(x0 + x, y0 + y, z, 1) = clear.at(x, y, z);
        }
  }

  // What each cloud is in the table, and the circle on the ground that it stands on.
  struct Entry {
    std::array<glm::vec4, 3> texels;
    glm::dvec2 middleM;
    double radiusM;
  };
  std::vector<Entry> entries;
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const scene::MetaballInstances::Instance& cloud : clouds.instances) {
    const field::Box& box = clouds.shapes[cloud.shape].box;
    const double c = std::cos(cloud.turnRad), s = std::sin(cloud.turnRad);
    const glm::dvec3 p = cloud.scale * 0.5 * (box.low + box.high),
                     half = cloud.scale * 0.5 * (box.high - box.low);
    const glm::dvec3 middle = cloud.positionM + glm::dvec3(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
    // As lib/clouds.glsl has it of layers.
    const double depthM = 2.0 * half.z;
    const double stepM = std::max(std::min(0.25 / cloud.extinctionPerM, 0.07 * depthM), 0.006 * depthM);
    const std::size_t column = cloud.shape % static_cast<std::size_t>(columns),
                      row = cloud.shape / static_cast<std::size_t>(columns);
    const double radiusM = std::hypot(half.x, half.y);
    entries.push_back(
        {{glm::vec4(middle, cloud.extinctionPerM),
          glm::vec4(c, s, static_cast<float>(column), static_cast<float>(row)), glm::vec4(1.0 / half, stepM)},
         glm::dvec2(middle),
         radiusM});
    low = glm::min(low, middle - glm::dvec3(radiusM, radiusM, half.z));
    high = glm::max(high, middle + glm::dvec3(radiusM, radiusM, half.z));
  }
  out.lowM = static_cast<float>(low.z);
  out.highM = static_cast<float>(high.z);

  const glm::dvec2 size = glm::dvec2(high) - glm::dvec2(low);
  const double cellM = std::max(std::max(size.x, size.y) / kMostCells, kLeastCellM);
  const glm::ivec2 cells = glm::max(glm::ivec2(glm::ceil(size / cellM)), 1);
  const auto cellCount = static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y);
  std::vector<glm::vec4> table(cellCount);
  for (std::size_t n = 0; n < cellCount; ++n) {
    const std::size_t i = n % static_cast<std::size_t>(cells.x), j = n / static_cast<std::size_t>(cells.x);
    const glm::dvec2 from =
                         glm::dvec2(low) + cellM * glm::dvec2(static_cast<double>(i), static_cast<double>(j)),
                     to = from + cellM;
    double clear = 1e9;
    glm::vec4 cell(static_cast<float>(table.size()), 0.0f, 0.0f, 0.0f);
    for (const Entry& e : entries) {
      const double away = glm::length(glm::clamp(e.middleM, from, to) - e.middleM) - e.radiusM;
      clear = std::min(clear, away);
      if (away >= 0.0) continue;
      table.insert(table.end(), e.texels.begin(), e.texels.end());
      cell.y += 1.0f;
    }
    cell.z = static_cast<float>(std::max(clear, 0.0));
    table[n] = cell;
  }
  const int tableRows =
      static_cast<int>(table.size() + BallVolume::kTableWidth - 1) / BallVolume::kTableWidth;
  out.table = Image<float>(BallVolume::kTableWidth, tableRows, 4);
  for (std::size_t n = 0; n < table.size(); ++n)
    for (int k = 0; k < 4; ++k) out.table.data[4 * n + static_cast<std::size_t>(k)] = table[n][k];
  out.uniforms = {{"uBallGrid", glm::vec4(low.x, low.y, cellM, 0.0)},
                  {"uBallCells", glm::vec2(cells)},
                  {"uBallTiles", glm::vec3(side, columns, rows)}};
  return out;
}

}  // namespace welkin::shading
