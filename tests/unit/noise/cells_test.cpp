// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "welkin/core/random.h"

namespace welkin::noise {
namespace {

CellLattice lattice(int axes, double period, std::optional<double> time = {}) {
  return {axes, {Axis(11, period, 0, 1), Axis(22, period, 0, 1), Axis(33, period, 0, 1)}, time, 0.0};
}

// A distance function: it cannot change faster than position.
TEST(Cells, DistancesChangeNoFasterThanPosition) {
  Random random(4);
  for (const int axes : {2, 3}) {
    const CellLattice cells = lattice(axes, 6);
    for (int i = 0; i < 2000; ++i) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      const Distances a = cells.at({x, y, z}), b = cells.at({x + 0.01 / 6, y, z});
      EXPECT_LE(std::abs(a.f1 - b.f1), 0.0101);
      EXPECT_LE(std::abs(a.f2 - b.f2), 0.0101);
      EXPECT_LE(a.f1, a.f2);
    }
  }
}

// Points fill their cells evenly, at any time: mean and variance of the uniform distribution on each axis, no
// correlation between axes (a point that only moves along a diagonal would have it).
TEST(Cells, PointsAreUniformAndIndependent) {
  for (const auto& time :
       {std::optional<double>(), std::optional<double>(3.7), std::optional<double>(-41.2)}) {
    const CellLattice cells = lattice(3, 64, time);
    std::array<double, 3> sum{}, squares{}, products{};
    const int n = 40000;
    for (int i = 0; i < n; ++i) {
      const FeaturePlace p = cells.place(mix32(static_cast<std::uint32_t>(i) * 77u));
      for (int a = 0; a < 3; ++a) {
        ASSERT_GE(p.inside[a], 0.0f);
        ASSERT_LT(p.inside[a], 1.0f);
        sum[a] += p.inside[a] / n;
        squares[a] += (p.inside[a] - 0.5) * (p.inside[a] - 0.5) / n;
        products[a] += (p.inside[a] - 0.5) * (p.inside[(a + 1) % 3] - 0.5) / n;
      }
    }
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(sum[a], 0.5, 0.006);
      EXPECT_NEAR(squares[a], 1.0 / 12.0, 0.002);
      EXPECT_NEAR(products[a], 0.0, 0.002);
    }
  }
}

// No cell is like another under a small shift: all 96^3 cells have places of their own.
TEST(Cells, NoneRepeatsUnderSmallShifts) {
  const int n = 96;
  const CellLattice cells = lattice(3, n);
  auto place = [&](int i, int j, int k) {
    return cells.place(cells.axis(0).hash((i + n) % n) + cells.axis(1).hash((j + n) % n) +
                       cells.axis(2).hash((k + n) % n));
  };
  for (int dz = -4; dz <= 4; ++dz)
    for (int dy = -4; dy <= 4; ++dy)
      for (int dx = -4; dx <= 4; ++dx) {
        if (dx == 0 && dy == 0 && dz == 0) continue;
        int equal = 0;
        double correlation = 0.0;
        for (int i = 0; i < 1000; ++i) {
          const int x = i % 10 * 9, y = i / 10 % 10 * 9, z = i / 100 * 9;
          const FeaturePlace a = place(x, y, z), b = place(x + dx, y + dy, z + dz);
          equal += a.inside[0] == b.inside[0];
          for (int c = 0; c < 3; ++c)
            correlation += (a.inside[c] - 0.5) * (b.inside[c] - 0.5) * 12.0 / 3000.0;
        }
        EXPECT_LE(equal, 1);
        EXPECT_NEAR(correlation, 0.0, 0.1) << dx << " " << dy << " " << dz;
      }
}

TEST(Cells, PointsMoveWithoutJumps) {
  for (std::uint32_t h = 0; h < 200; ++h) {
    float before = lattice(3, 8, 0.0).place(mix32(h)).inside[0];
    for (int step = 1; step <= 100; ++step) {
      const float now = lattice(3, 8, 0.05 * step).place(mix32(h)).inside[0];
      EXPECT_LE(std::abs(now - before), 0.051f);
      before = now;
    }
  }
}

}  // namespace
}  // namespace welkin::noise
