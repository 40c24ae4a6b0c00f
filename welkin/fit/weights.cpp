// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/weights.h"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <utility>

#include "welkin/core/parallel.h"

namespace welkin::fit {
namespace {

constexpr double kRidge = 1e-7;      // of a ball's own square: balls on top of one another share
constexpr double kTolerance = 1e-7;  // of the largest weight
constexpr int kMostSweeps = 300;

using Matrix = Eigen::SparseMatrix<double>;

// Products of the balls' functions with one another and with the map; false, and not all, where it got late.
bool normalEquations(const DensityGrid& data, std::span<const GridBall> balls, Matrix& products,
                     Eigen::VectorXd& right, const std::function<bool()>& late) {
  const auto neighbours = neighboursOf(balls);
  std::vector<std::vector<Eigen::Triplet<double>>> rows(balls.size());
  const auto n = static_cast<Eigen::Index>(balls.size());
  right.resize(n);
  parallelFor(balls.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !late(); ++i) {
      const auto at = static_cast<int>(i);
      const BallGain own = gainOfBall(data.grid, balls[i], data.density.data());
      right[at] = own.fr;
      // A ball between voxels is worth nothing, and gets nothing.
      rows[i].emplace_back(at, at, own.ff > 0.0 ? own.ff * (1.0 + kRidge) : 1.0);
      if (own.ff <= 0.0) continue;
      const BallPatch patch = patchOf(data.grid, balls[i], 1.0);
      for (const std::uint32_t j : neighbours[i]) {
        if (j < i) continue;
        const double product = gainOfBall(patch.grid, balls[j], patch.voxels.data()).fr;
        if (product == 0.0) continue;
        rows[i].emplace_back(at, static_cast<int>(j), product);
        rows[i].emplace_back(static_cast<int>(j), at, product);
      }
    }
  });
  if (late()) return false;
  std::vector<Eigen::Triplet<double>> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  products.resize(n, n);
  products.setFromTriplets(all.begin(), all.end());
  return true;
}

void descend(const Matrix& products, const Eigen::VectorXd& right, const std::function<bool()>& late,
             Eigen::VectorXd& w) {
  Eigen::VectorXd slope = products * w - right;
  const Eigen::VectorXd diagonal = products.diagonal();
  for (int sweep = 0; sweep < kMostSweeps && !late(); ++sweep) {
    double change = 0.0;
    for (Eigen::Index i = 0; i < w.size(); ++i) {
      const double next = std::max(0.0, w[i] - slope[i] / diagonal[i]);
      const double step = next - w[i];
      if (step == 0.0) continue;
      w[i] = next;
      change = std::max(change, std::abs(step));
      for (Matrix::InnerIterator it(products, i); it; ++it) slope[it.row()] += step * it.value();
    }
    if (change <= kTolerance * w.maxCoeff()) return;
  }
}

}  // namespace

bool solveWeights(const DensityGrid& data, std::span<GridBall> balls, bool isSigned,
                  const std::function<bool()>& late) {
  Matrix products;
  Eigen::VectorXd right;
  if (!normalEquations(data, balls, products, right, late)) return false;
  Eigen::VectorXd w(right.size());
  for (std::size_t i = 0; i < balls.size(); ++i) w[static_cast<Eigen::Index>(i)] = balls[i].weight;
  if (isSigned) {
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(kTolerance);
    solver.setMaxIterations(kMostSweeps);
    w = solver.compute(products).solveWithGuess(right, w);
  } else {
    w = w.cwiseMax(0.0);
    descend(products, right, late, w);
  }
  for (std::size_t i = 0; i < balls.size(); ++i) balls[i].weight = w[static_cast<Eigen::Index>(i)];
  return true;
}

void scaleWeights(const DensityGrid& data, std::span<GridBall> balls) {
  // |s a - b|^2 is least at s = a b / a a, and r = a - b is what residual() gives.
  std::vector<float> r;
  residual(data, balls, BallLists(data.grid, balls), r);
  double aa = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double b = static_cast<double>(data.density[i]), a = static_cast<double>(r[i]) + b;
    aa += a * a;
    ab += a * b;
  }
  const double scale = aa > 0.0 ? ab / aa : 0.0;
  for (GridBall& ball : balls) ball.weight *= scale;
}

}  // namespace welkin::fit
