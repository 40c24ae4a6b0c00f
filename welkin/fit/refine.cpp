// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/refine.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace welkin::fit {
namespace {

constexpr int kTries = 8;  // of larger lambdas, before the minimum is taken for reached
constexpr double kFirstLambda = 1e-2, kLeastLambda = 1e-6;
constexpr double kLeastKept = 0.1;   // of a weight, in one step
constexpr double kMostGrowth = 0.7;  // of ln R, in one step

using Block = Eigen::Matrix<double, 5, 5>;
using Five = Eigen::Matrix<double, 5, 1>;
using Vector = Eigen::VectorXd;

std::span<const double> spanOf(const Vector& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<double> spanOf(Vector& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

// (J^T J + lambda D) x = -gradient at one set of balls.
class Step {
 public:
  Step(const DensityGrid& data, std::span<const GridBall> balls, const std::vector<float>& r)
      : jacobian_(data, balls), blocks_(jacobian_.blocks()) {
    const auto n = static_cast<Eigen::Index>(jacobian_.columns());
    gradient_.resize(n);
    jacobian_.transposedTimes(r, spanOf(gradient_));
    // A ball of weight 0 has no derivatives but one, and one between voxels none: they stay where they are.
    diagonal_.resize(n);
    double largest = 0.0;
    for (const BallBlock& b : blocks_) largest = std::max(largest, b[0]);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double own = blocks_[static_cast<std::size_t>(j / 5)][static_cast<std::size_t>(6 * (j % 5))];
      diagonal_[j] = own > 0.0 ? own : std::max(largest, 1e-30);
    }
  }

  // Returns how much |r|^2 should fall.
  double solve(double lambda, const RefineParams& params, const FitControl& control, Vector& x) {
    std::vector<Eigen::LLT<Block>> factors;
    factors.reserve(blocks_.size());
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      Block b = Eigen::Map<const Block>(blocks_[i].data());
      b.diagonal() += (lambda + 1e-9) * diagonal_.segment<5>(static_cast<Eigen::Index>(5 * i));
      factors.emplace_back(b);
    }
    const auto precondition = [&](const Vector& v, Vector& out) {
      for (std::size_t i = 0; i < factors.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(5 * i);
        out.segment<5>(at) = factors[i].solve(Five(v.segment<5>(at)));
      }
    };
    const Eigen::Index n = gradient_.size();
    x.setZero(n);
    Vector left = -gradient_, z(n), q(n);
    precondition(left, z);
    Vector p = z;
    double rz = left.dot(z);
    const double enough = params.innerTolerance * params.innerTolerance * rz;
    for (int i = 0; i < params.innerSteps && rz > enough; ++i) {
      control.check();
      jacobian_.times(spanOf(std::as_const(p)), voxels_);
      jacobian_.transposedTimes(voxels_, spanOf(q));
      q += lambda * diagonal_.cwiseProduct(p);
      const double pq = p.dot(q);
      if (!(pq > 0.0)) break;
      x += rz / pq * p;
      left -= rz / pq * q;
      precondition(left, z);
      const double next = left.dot(z);
      p = z + next / rz * p;
      rz = next;
    }
    // Conjugate gradients leave x A x = -gradient x, with A that includes lambda D.
    return -gradient_.dot(x) + lambda * x.dot(diagonal_.cwiseProduct(x));
  }

 private:
  Jacobian jacobian_;
  std::vector<BallBlock> blocks_;
  Vector gradient_, diagonal_;
  std::vector<float> voxels_;
};

void take(const Vector& x, const RefineParams& params, std::vector<GridBall>& balls) {
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(5 * i);
    GridBall& b = balls[i];
    const double weight = b.weight + x[at];
    b.weight = params.isSigned ? weight : std::max(weight, kLeastKept * b.weight);
    // A step beyond the ball itself leaves what the derivatives know.
    glm::dvec3 move(x[at + 1], x[at + 2], x[at + 3]);
    const double length = std::sqrt(move.x * move.x + move.y * move.y + move.z * move.z);
    if (length > b.radius) move *= b.radius / length;
    b.centre += move;
    const double growth = std::clamp(x[at + 4], -kMostGrowth, kMostGrowth);
    b.radius = std::clamp(b.radius * std::exp(growth), params.leastRadius, params.greatestRadius);
  }
}

}  // namespace

double refine(const DensityGrid& data, std::vector<GridBall>& balls, const RefineParams& params,
              const FitControl& control) {
  std::vector<float> r, nextR;
  double squares = residual(data, balls, BallLists(data.grid, balls), r);
  double lambda = kFirstLambda;
  Vector x;
  for (int i = 0; i < params.steps && !control.late(); ++i) {
    const std::vector<GridBall> from = balls;  // the Jacobian's, while `balls` become better
    Step step(data, from, r);
    bool better = false;
    for (int attempt = 0; attempt < kTries && !better && !control.late(); ++attempt) {
      const double expected = step.solve(lambda, params, control, x);
      std::vector<GridBall> next = from;
      take(x, params, next);
      const double nextSquares = residual(data, next, BallLists(data.grid, next), nextR);
      better = nextSquares < squares;
      if (!better) {
        lambda *= 4.0;
        continue;
      }
      const double gained = squares - nextSquares, share = gained / squares;
      balls = std::move(next);
      std::swap(r, nextR);
      squares = nextSquares;
      if (gained > 0.6 * expected)
        lambda = std::max(lambda / 3.0, kLeastLambda);
      else if (gained < 0.2 * expected)
        lambda *= 2.5;
      if (share < params.tolerance) return squares;
    }
    if (!better) break;
  }
  return squares;
}

}  // namespace welkin::fit
