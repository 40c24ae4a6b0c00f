// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/refine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "welkin/core/random.h"
#include "welkin/fit/relocate.h"
#include "welkin/fit/weights.h"

namespace welkin::fit {
namespace {

// Oblong voxels, and a row length that is no multiple of a vector.
DensityGrid someMap(int nx = 21, int ny = 18, int nz = 14) {
  Volume<float> map(nx, ny, nz, 1);
  Random random(11);
  for (float& v : map.data) v = random.uniform();
  return densityGrid(map, {nx, ny, nz, {10, 12, 15}, {-100, 50, 0}});
}

std::vector<GridBall> someBalls(const DensityGrid& data, int count, std::uint64_t seed = 2) {
  Random random(seed);
  std::vector<GridBall> balls;
  balls.reserve(static_cast<std::size_t>(count));
  const glm::dvec3 size = data.grid.step * glm::dvec3(data.grid.nx, data.grid.ny, data.grid.nz);
  for (int i = 0; i < count; ++i)
    balls.push_back(
        {data.grid.first + size * glm::dvec3(random.uniform(), random.uniform(), random.uniform()),
         25.0 + 50.0 * random.uniform(), 0.2 + random.uniform()});
  return balls;
}

const FitControl kFree{[] {}, [] { return false; }};

GridBall moved(const GridBall& b, int parameter, double by) {
  GridBall m = b;
  if (parameter == 0) m.weight += by;
  if (parameter >= 1 && parameter <= 3) m.centre[parameter - 1] += by;
  if (parameter == 4) m.radius *= std::exp(by);
  return m;
}

TEST(Refine, GradientIsThatOfTheError) {
  const DensityGrid data = someMap();
  const std::vector<GridBall> balls = someBalls(data, 6);
  std::vector<float> r;
  residual(data, balls, BallLists(data.grid, balls), r);
  const Jacobian jacobian(data, balls);
  std::vector<double> gradient(jacobian.columns());
  jacobian.transposedTimes(r, gradient);
  const auto halfSquares = [&](const std::vector<GridBall>& at) {  // in doubles, from the definition
    double sum = 0.0;
    for (int z = 0; z < data.grid.nz; ++z)
      for (int y = 0; y < data.grid.ny; ++y)
        for (int x = 0; x < data.grid.nx; ++x) {
          double v = -static_cast<double>(data.density[data.grid.row(y, z) + static_cast<std::size_t>(x)]);
          const glm::dvec3 p = data.grid.first + data.grid.step * glm::dvec3(x, y, z);
          for (const GridBall& b : at) {
            const glm::dvec3 d = p - b.centre;
            v +=
                b.weight * field::wyvillOfSquare((d.x * d.x + d.y * d.y + d.z * d.z) / (b.radius * b.radius));
          }
          sum += 0.5 * v * v;
        }
    return sum;
  };
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (int k = 0; k < 5; ++k) {
      const double h = k == 0 || k == 4 ? 1e-4 : 1e-2;
      std::vector<GridBall> up = balls, down = balls;
      up[i] = moved(balls[i], k, h);
      down[i] = moved(balls[i], k, -h);
      const double slope = (halfSquares(up) - halfSquares(down)) / (2.0 * h);
      const double found = gradient[5 * i + static_cast<std::size_t>(k)];
      EXPECT_NEAR(found, slope, 2e-4 * (1.0 + std::abs(slope))) << i << " " << k;
    }
}

// <J p, r> = <p, J^T r>, and the blocks are J^T J's own.
TEST(Refine, JacobianAndItsTransposeAgree) {
  const DensityGrid data = someMap();
  const std::vector<GridBall> balls = someBalls(data, 9);
  const Jacobian jacobian(data, balls);
  Random random(4);
  std::vector<double> p(jacobian.columns()), back(jacobian.columns());
  for (double& v : p) v = random.uniform() - 0.5;
  std::vector<float> image;
  jacobian.times(p, image);
  jacobian.transposedTimes(data.density, back);
  double left = 0.0, right = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i)
    left += static_cast<double>(image[i]) * static_cast<double>(data.density[i]);
  for (std::size_t j = 0; j < p.size(); ++j) right += p[j] * back[j];
  EXPECT_NEAR(left, right, 1e-5 * std::abs(left));
  const std::vector<BallBlock> blocks = jacobian.blocks();
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (std::size_t k = 0; k < 5; ++k) {
      std::vector<double> unit(p.size(), 0.0);
      unit[5 * i + k] = 1.0;
      jacobian.times(unit, image);
      jacobian.transposedTimes(image, back);
      for (std::size_t l = 0; l < 5; ++l)
        EXPECT_NEAR(back[5 * i + l], blocks[i][5 * k + l],
                    1e-4 * std::sqrt(blocks[i][6 * k] * blocks[i][6 * l]) + 1e-9);
    }
}

TEST(Refine, WeightsAreTheLeastSquares) {
  const DensityGrid data = someMap();
  for (const bool isSigned : {false, true}) {
    std::vector<GridBall> balls = someBalls(data, 25);
    EXPECT_TRUE(solveWeights(data, balls, isSigned, kFree.late));
    std::vector<float> r;
    residual(data, balls, BallLists(data.grid, balls), r);
    bool negative = false;
    for (const GridBall& b : balls) {
      const BallGain g = gainOfBall(data.grid, b, r.data());
      negative = negative || b.weight < 0.0;
      // Where a weight is free nothing is left along its ball; where it is 0 more of it would not help.
      if (b.weight != 0.0)
        EXPECT_NEAR(g.fr / g.ff, 0.0, 1e-3);
      else
        EXPECT_GT(g.fr, -1e-3 * g.ff);
    }
    EXPECT_EQ(negative, isSigned) << "the balls overlap enough for both";
  }
}

TEST(Refine, ErrorsFallFromStepToStep) {
  const DensityGrid data = someMap();
  std::vector<GridBall> balls = someBalls(data, 20);
  double before = 1e30;
  for (int i = 0; i < 6; ++i) {
    const double now =
        refine(data, balls, {.leastRadius = 10, .greatestRadius = 500, .steps = 1, .tolerance = 0}, kFree);
    EXPECT_LT(now, before);
    before = now;
  }
  for (const GridBall& b : balls) {
    EXPECT_GE(b.weight, 0.0);
    EXPECT_GE(b.radius, 10.0);
  }
}

// A map of three balls that lacks one: it is put where it belongs.
TEST(Relocate, FindsWhatIsMissing) {
  const std::vector<field::Metaball> truth = {
      {{100, 100, 100}, 60, 1}, {{220, 100, 100}, 60, 1}, {{160, 200, 140}, 50, 0.8}};
  const Volume<float> map = field::rasterise(truth, {32, 32, 24, glm::dvec3(10), glm::dvec3(0)});
  const DensityGrid data = densityGrid(map, {32, 32, 24, glm::dvec3(10), glm::dvec3(0)});
  // The third sits uselessly where the first is.
  std::vector<GridBall> balls = {
      {{100, 100, 100}, 60, 0.9}, {{220, 100, 100}, 60, 1}, {{105, 100, 100}, 55, 0.1}};
  const RefineParams params{.leastRadius = 10, .greatestRadius = 500};
  balls = relocated(data, balls, {.count = 1}, params, kFree);
  ASSERT_EQ(balls.size(), 3U);
  const double squares = refine(data, balls, params, kFree);
  EXPECT_LT(std::sqrt(squares / data.squares), 1e-2);
  bool found = false;
  for (const GridBall& b : balls)
    found =
        found || std::abs(b.centre.x - 160) + std::abs(b.centre.y - 200) + std::abs(b.centre.z - 140) < 3.0;
  EXPECT_TRUE(found);
}

// One ball over two that overlap, and two over one: refining stays there, and a detour leads out.
TEST(Relocate, GoesRoundAMinimum) {
  const std::vector<field::Metaball> truth = {
      {{100, 100, 100}, 60, 1}, {{150, 110, 100}, 55, 0.8}, {{250, 220, 140}, 60, 1}};
  const field::VoxelFrame frame{32, 32, 24, glm::dvec3(10), glm::dvec3(0)};
  const DensityGrid data = densityGrid(field::rasterise(truth, frame), frame);
  const RefineParams params{.leastRadius = 10, .greatestRadius = 500};
  std::vector<GridBall> balls = {
      {{125, 105, 100}, 75, 1}, {{245, 215, 140}, 60, 0.5}, {{255, 225, 140}, 60, 0.5}};
  const double there = refine(data, balls, params, kFree);
  EXPECT_GT(std::sqrt(there / data.squares), 0.1);
  const std::vector<GridBall> from = balls;
  const double squares = goRound(data, balls, {.more = 2, .enough = 0.25 * there}, params, kFree);
  EXPECT_EQ(balls.size(), 3U);
  EXPECT_LT(std::sqrt(squares / data.squares), 1e-3);
  // Not for what no number of balls could do.
  balls = from;
  EXPECT_TRUE(std::isinf(goRound(data, balls, {.more = 2, .enough = 0.0}, params, kFree)));
}

TEST(DensityGrid, CoarserKeepsTheMassAndThePlace) {
  const DensityGrid fine = someMap(13, 8, 1);
  const DensityGrid coarse = coarser(fine);
  EXPECT_EQ(coarse.grid.nx, 7);
  EXPECT_EQ(coarse.grid.ny, 4);
  EXPECT_EQ(coarse.grid.nz, 1);
  EXPECT_EQ(coarse.grid.step, glm::dvec3(20, 24, 15));
  EXPECT_EQ(coarse.grid.first, fine.grid.first + glm::dvec3(5, 6, 0));
  double a = 0.0, b = 0.0;
  for (const float v : fine.density) a += static_cast<double>(v);
  for (const float v : coarse.density) b += 4.0 * static_cast<double>(v);
  EXPECT_NEAR(a, b, 1e-4 * a);
}

}  // namespace
}  // namespace welkin::fit
