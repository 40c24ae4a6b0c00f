// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/relocate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "welkin/core/parallel.h"

namespace welkin::fit {
namespace {

constexpr double kRadii[] = {0.5, 0.8, 1.25, 1.8};  // tried, of the typical radius
constexpr double kSpacing = 0.7;                    // of the places tried
constexpr double kNear = 0.7;  // neighbours nearer than this share of both radii can do a ball's work
constexpr std::size_t kGrain = 32;
constexpr int kFewSteps = 6;
constexpr double kHopeless = 3.0;  // of what is enough, after so few steps

using Block = Eigen::Matrix<double, 5, 5>;
using Five = Eigen::Matrix<double, 5, 1>;

std::vector<double> worthOf(const DensityGrid& data, const std::vector<GridBall>& balls) {
  const auto neighbours = neighboursOf(balls);
  const std::vector<BallBlock> blocks = Jacobian(data, balls).blocks();
  std::vector<double> worth(balls.size(), 0.0);
  parallelFor(balls.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const GridBall& ball = balls[i];
      const BallPatch patch = patchOf(data.grid, ball, ball.weight);
      double replaced = 0.0;
      for (const std::uint32_t j : neighbours[i]) {
        const double reach = kNear * (ball.radius + balls[j].radius);
        if (square(balls[j].centre - ball.centre) > reach * reach || balls[j].weight == 0.0) continue;
        const BallStep s = gatherBall(patch.grid, balls[j], patch.voxels.data());
        const Five g(s.weight, s.centre.x, s.centre.y, s.centre.z, s.logRadius);
        Block b = Eigen::Map<const Block>(blocks[j].data());
        b.diagonal() *= 1.0 + 1e-4;
        const Eigen::LLT<Block> factor(b);
        if (factor.info() == Eigen::Success) replaced = std::max(replaced, g.dot(factor.solve(g)));
      }
      const double own = ball.weight * ball.weight * gainOfBall(data.grid, ball, data.density.data()).ff;
      worth[i] = std::max(own - replaced, 0.0);
    }
  });
  return worth;
}

struct Candidate {
  double gain = 0.0;
  GridBall ball;
};

class Placer {
 public:
  Placer(const DensityGrid& data, std::vector<float>& r, double typicalRadius, const RefineParams& params)
      : data_(data), r_(r), params_(params) {
    for (const double f : kRadii) radii_.push_back(std::max(f * typicalRadius, params.leastRadius));
    const BallGrid& grid = data.grid;
    glm::ivec3 stride;
    for (int a = 0; a < 3; ++a)
      stride[a] =
          static_cast<int>(std::clamp(std::round(kSpacing * typicalRadius / grid.step[a]), 1.0, 1024.0));
    for (int z = stride.z / 2; z < grid.nz; z += stride.z)
      for (int y = stride.y / 2; y < grid.ny; y += stride.y)
        for (int x = stride.x / 2; x < grid.nx; x += stride.x)
          places_.push_back(grid.first + glm::dvec3(x, y, z) * grid.step);
    best_.resize(places_.size());
    std::vector<std::size_t> all(places_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    evaluate(all);
  }

  // No ball within the best one, for now.
  void passOver() {
    const auto best = bestOfAll();
    if (best == best_.end()) return;
    const GridBall ball = best->ball;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (square(places_[i] - ball.centre) < ball.radius * ball.radius) best_[i].gain = 0.0;
  }

  // The best ball, which is subtracted from the residual; false if none helps.
  bool next(GridBall& ball) {
    const auto best = bestOfAll();
    if (best == best_.end() || !(best->gain > 0.0)) return false;
    ball = best->ball;
    field::addBall(data_.grid, ball, ball.weight, field::slicesOf(data_.grid, ball), r_.data());
    const double reach = ball.radius + radii_.back();
    std::vector<std::size_t> changed;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (square(places_[i] - ball.centre) < reach * reach) changed.push_back(i);
    evaluate(changed);
    return true;
  }

 private:
  std::vector<Candidate>::const_iterator bestOfAll() const {
    return std::max_element(best_.begin(), best_.end(),
                            [](const Candidate& a, const Candidate& b) { return a.gain < b.gain; });
  }

  void evaluate(const std::vector<std::size_t>& which) {
    parallelFor(which.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) best_[which[n]] = bestAt(places_[which[n]]);
    });
  }

  Candidate bestAt(const glm::dvec3& centre) const {
    Candidate best;
    for (const double radius : radii_) {
      GridBall ball{centre, radius, 0.0};
      const BallGain g = gainOfBall(data_.grid, ball, r_.data());
      if (g.ff <= 0.0 || (!params_.isSigned && g.fr >= 0.0)) continue;
      const double gain = g.fr * g.fr / g.ff;
      if (gain <= best.gain) continue;
      ball.weight = -g.fr / g.ff;
      best = {gain, ball};
    }
    return best;
  }

  const DensityGrid& data_;
  std::vector<float>& r_;
  const RefineParams& params_;
  std::vector<double> radii_;
  std::vector<glm::dvec3> places_;
  std::vector<Candidate> best_;
};

// All but those that would be missed least, but for the first so many of them.
std::vector<GridBall> without(const DensityGrid& data, const std::vector<GridBall>& balls, std::size_t count,
                              std::size_t spared) {
  const std::vector<double> worth = worthOf(data, balls);
  std::vector<std::size_t> order(balls.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return worth[a] != worth[b] ? worth[a] < worth[b] : a < b; });
  std::vector<bool> taken(balls.size(), false);
  for (std::size_t i = spared; i < std::min(spared + count, order.size()); ++i) taken[order[i]] = true;
  std::vector<GridBall> kept;
  for (std::size_t i = 0; i < balls.size(); ++i)
    if (!taken[i]) kept.push_back(balls[i]);
  return kept;
}

double meanRadius(const std::vector<GridBall>& balls) {
  double radii = 0.0;
  for (const GridBall& b : balls) radii += b.radius;
  return radii / static_cast<double>(balls.size());
}

// Fewer if nothing is left to be fitted.
void placeUpTo(std::size_t count, double typicalRadius, std::size_t passed, const DensityGrid& data,
               std::vector<GridBall>& balls, const RefineParams& params, const FitControl& control) {
  std::vector<float> r;
  residual(data, balls, BallLists(data.grid, balls), r);
  Placer placer(data, r, typicalRadius, params);
  for (std::size_t i = 0; i < passed; ++i) placer.passOver();
  while (balls.size() < count) {
    control.check();
    GridBall ball;
    if (!placer.next(ball)) break;
    balls.push_back(ball);
  }
}

}  // namespace

std::vector<GridBall> relocated(const DensityGrid& data, const std::vector<GridBall>& balls, const Move& move,
                                const RefineParams& params, const FitControl& control) {
  control.check();
  std::vector<GridBall> kept = without(data, balls, move.count, move.spared);
  placeUpTo(balls.size(), meanRadius(balls), move.passed, data, kept, params, control);
  return kept;
}

double goRound(const DensityGrid& data, std::vector<GridBall>& balls, const Detour& detour,
               const RefineParams& params, const FitControl& control) {
  const std::size_t count = balls.size();
  placeUpTo(count + detour.more, meanRadius(balls), detour.passed, data, balls, params, control);
  // A few steps tell what is hopeless.
  RefineParams few = params;
  few.steps = kFewSteps;
  double squares = refine(data, balls, few, control);
  if (squares > kHopeless * detour.enough) return std::numeric_limits<double>::infinity();
  squares = refine(data, balls, params, control);
  if (squares > detour.enough) return std::numeric_limits<double>::infinity();
  while (balls.size() > count) {
    control.check();
    balls = without(data, balls, 1, 0);
    squares = refine(data, balls, params, control);
  }
  return squares;
}

}  // namespace welkin::fit
