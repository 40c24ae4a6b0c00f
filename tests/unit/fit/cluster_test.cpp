// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/cluster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "welkin/core/parallel.h"
#include "welkin/core/random.h"

namespace welkin::fit {
namespace {

DensityGrid randomMap(int nx, int ny, int nz) {
  Volume<float> map(nx, ny, nz, 1);
  Random random(7);
  for (float& v : map.data) v = random.uniform() < 0.4F ? 0.0F : random.uniform();
  return densityGrid(map, {nx, ny, nz, {10, 10, 10}, {-50, 0, 20}});
}

const FitControl kFree{[] {}, [] { return false; }};

// Sum over the voxels of weight times squared distance to the nearest centre, by looking at all of them.
double costOf(const DensityGrid& data, const std::vector<Cluster>& found, bool weighted) {
  double cost = 0.0;
  for (int z = 0; z < data.grid.nz; ++z)
    for (int y = 0; y < data.grid.ny; ++y)
      for (int x = 0; x < data.grid.nx; ++x) {
        const auto w = static_cast<double>(data.density[data.grid.row(y, z) + static_cast<std::size_t>(x)]);
        if (w == 0.0) continue;
        double best = 1e30;
        for (const Cluster& c : found)
          best = std::min(best, square(data.grid.first + data.grid.step * glm::dvec3(x, y, z) - c.centre));
        cost += (weighted ? w : 1.0) * best;
      }
  return cost;
}

TEST(Cluster, CentresAreTheMeansOfWhatIsNearestToThem) {
  const DensityGrid data = randomMap(20, 17, 9);
  const std::vector<Cluster> found = clusters(data, 40, 1, kFree);
  ASSERT_EQ(found.size(), 40U);
  std::vector<glm::dvec3> sums(40, glm::dvec3(0.0));
  std::vector<double> weights(40), squares(40), densities(40), counts(40);
  for (int z = 0; z < 9; ++z)
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 20; ++x) {
        const auto w = static_cast<double>(data.density[data.grid.row(y, z) + static_cast<std::size_t>(x)]);
        if (w == 0.0) continue;
        const glm::dvec3 p = data.grid.first + data.grid.step * glm::dvec3(x, y, z);
        std::size_t k = 0;
        for (std::size_t i = 1; i < 40; ++i)
          if (square(p - found[i].centre) < square(p - found[k].centre)) k = i;
        sums[k] += w * p, weights[k] += w, squares[k] += w * square(p - found[k].centre);
        densities[k] += w, counts[k] += 1.0;
      }
  for (std::size_t k = 0; k < 40; ++k) {
    // The rounds end before the last voxel has found its place.
    EXPECT_LT(std::sqrt(square(sums[k] / weights[k] - found[k].centre)), 1.5)
        << "a tenth of a voxel and a half";
    EXPECT_NEAR(found[k].spread, std::sqrt(squares[k] / weights[k]), 1e-9);
    EXPECT_NEAR(found[k].density, densities[k] / counts[k], 1e-9);
  }
}

TEST(Cluster, IsAsGoodAsALatticeAndBetterThanTheOnlineRule) {
  const DensityGrid data = randomMap(24, 24, 24);
  const double lloyd = costOf(data, clusters(data, 64, 1, kFree), true);
  std::vector<Cluster> lattice;
  for (int i = 0; i < 64; ++i)
    lattice.push_back({data.grid.first + 10.0 * (glm::dvec3(i % 4, i / 4 % 4, i / 16) * 6.0 + 2.5), 0, 0});
  // On white noise a lattice is hard to beat.
  EXPECT_LT(lloyd, 1.05 * costOf(data, lattice, true));
  EXPECT_LT(lloyd, costOf(data, manClusters(data, 64, 1, kFree), true) * 1.05);
  // The online rule minimises the unweighted cost, and comes near what a lattice reaches.
  EXPECT_LT(costOf(data, manClusters(data, 64, 1, kFree), false), 1.1 * costOf(data, lattice, false));
}

TEST(Cluster, AsManyAsVoxelsAreTheVoxels) {
  Volume<float> map(5, 4, 3, 1);
  for (const std::size_t i : {0U, 7U, 23U, 58U, 59U}) map.data[i] = static_cast<float>(i + 1);
  const DensityGrid data = densityGrid(map, {5, 4, 3});
  for (const auto& found : {clusters(data, 5, 3, kFree), manClusters(data, 5, 3, kFree)}) {
    ASSERT_EQ(found.size(), 5U);
    EXPECT_NEAR(costOf(data, found, true), 0.0, 1e-9);
    for (const Cluster& c : found) EXPECT_NEAR(c.spread, 0.0, 1e-9);
  }
}

TEST(Cluster, EndsWhenItIsLate) {
  const DensityGrid data = randomMap(30, 30, 30);
  for (const auto find : {clusters, manClusters}) {
    int checks = 0;
    const std::vector<Cluster> found = find(data, 50, 1, {[&] { ++checks; }, [&] { return checks >= 3; }});
    EXPECT_EQ(checks, 3);
    ASSERT_EQ(found.size(), 50U);
    for (const Cluster& c : found) EXPECT_GT(c.spread, 0.0);
  }
}

TEST(Cluster, ThreadsAndSeeds) {
  const DensityGrid data = randomMap(30, 30, 30);
  const auto centresOf = [&](std::uint64_t seed) {
    std::vector<glm::dvec3> centres;
    for (const Cluster& c : clusters(data, 50, seed, kFree)) centres.push_back(c.centre);
    return centres;
  };
  setThreadCount(1);
  const auto one = centresOf(1);
  setThreadCount(4);
  EXPECT_EQ(centresOf(1), one);
  EXPECT_NE(centresOf(2), one);
  setThreadCount(0);
}

}  // namespace
}  // namespace welkin::fit
