// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/fit_metaballs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/fit/cluster.h"
#include "welkin/fit/refine.h"
#include "welkin/fit/relocate.h"
#include "welkin/fit/weights.h"

namespace welkin::fit {
namespace {

using Clock = std::chrono::steady_clock;

// A coarser copy is worth its error where it still has that many voxels a ball, and the map is large.
constexpr double kVoxelsPerBall = 60.0;
constexpr std::int64_t kLargeMap = 1 << 18;
constexpr double kManSpread = 2.0, kFirstSpread = 2.2;
constexpr double kSpreads[] = {1.6, 2.0, 2.4, 2.8};
constexpr double kMovedFirst = 0.2,
                 kMovedLess = 0.6;  // share of the balls moved, and its factor when that failed
constexpr double kExact = 5e-4;     // relative error that needs no more rounds
constexpr double kNearlyExact = 0.2, kClose = 0.05;
constexpr double kWorthwhile = 0.25;  // of |r|^2, what kBallsMore have to leave at most
constexpr std::size_t kBallsMore = 7;
constexpr int kDetourRounds = 6, kDetourSteps = 25, kCloseInnerSteps = 100;
constexpr double kCloseInnerTolerance = 0.003;
constexpr std::size_t kFewBalls = 64;
constexpr std::size_t kSingleMoves = 2;
constexpr int kFirstSteps = 20, kRoundSteps = 10, kFewRoundSteps = 15, kFinerSteps = 8, kLastSteps = 60;

double secondsSince(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

std::vector<GridBall> gridBalls(std::span<const field::Metaball> balls, double unit) {
  std::vector<GridBall> out;
  for (const field::Metaball& b : balls) out.push_back({b.centreM, b.radiusM, b.density / unit});
  return out;
}

std::vector<field::Metaball> metaballs(std::span<const GridBall> balls, double unit) {
  std::vector<field::Metaball> out;
  for (const GridBall& b : balls) out.push_back({b.centre, b.radius, b.weight * unit});
  return out;
}

// One level, from nothing or from given balls to the end of its time.
class LevelFit {
 public:
  LevelFit(const std::vector<DensityGrid>& pyramid, const FitParams& params, const FitLevel& level,
           std::optional<Clock::time_point> end, std::function<void(double, double)> report)
      : pyramid_(pyramid), params_(params), count_(level.count), report_(std::move(report)) {
    balls_ = gridBalls(level.balls, pyramid[0].unit);
    control_.check = [this] { report_(done_, relative_); };
    control_.late = [end] { return end && Clock::now() > *end; };
  }

  const std::vector<GridBall>& balls() const { return balls_; }

  void run() {
    const bool fresh = balls_.empty();
    if (params_.method != FitMethod::kRefined) {
      if (fresh)
        begin(pyramid_[0], balls_);
      else if (params_.method == FitMethod::kMan)
        scaleWeights(pyramid_[0], balls_);
      else
        solveWeights(pyramid_[0], balls_, params_.isSigned, control_.late);
      return;
    }
    std::size_t depth = 0;
    while (fresh && depth + 1 < pyramid_.size() &&
           static_cast<double>(pyramid_[depth].cloudVoxels) > kVoxelsPerBall * static_cast<double>(count_) &&
           pyramid_[depth + 1].cloudVoxels >= static_cast<std::int64_t>(count_))
      ++depth;
    const int rounds = roundsFor(count_);
    stepsToDo_ = rounds + 2.0 * static_cast<double>(depth) + 4.0;
    if (fresh) begin(pyramid_[depth], balls_);
    refineOn(depth, kFirstSteps, 1e-4);
    stepDone(1.0);
    moveAbout(depth, rounds);
    if (fresh && depth == 0) findAll(depth);
    while (depth > 0) {
      refineOn(--depth, kFinerSteps, 1e-4);
      stepDone(2.0);
    }
    const bool large = pyramid_[0].voxels() > kLargeMap;
    refineOn(0, large ? kFinerSteps : kLastSteps, large ? 1e-4 : 1e-5);
  }

 private:
  int roundsFor(std::size_t count) const {
    const auto k = static_cast<double>(count);
    return static_cast<int>(std::lround(params_.effort * (7.0 - 5.0 * 100.0 / (k + 100.0))));
  }

  void stepDone(double steps) {
    stepsDone_ += steps;
    done_ = std::min(stepsDone_ / stepsToDo_, 1.0);
  }

  RefineParams refineParams(std::size_t depth) const {
    const BallGrid& grid = pyramid_[depth].grid;
    RefineParams r;
    r.isSigned = params_.isSigned;
    r.leastRadius = params_.leastRadiusVoxels * std::max({grid.step.x, grid.step.y, grid.step.z});
    const glm::dvec3 size = grid.step * glm::dvec3(grid.nx, grid.ny, grid.nz);
    r.greatestRadius = std::max(r.leastRadius, size.x + size.y + size.z);
    return r;
  }

  void begin(const DensityGrid& data, std::vector<GridBall>& begun, std::uint64_t start = 0) {
    const bool man = params_.method == FitMethod::kMan;
    const std::uint64_t seed = hashOf(static_cast<std::uint64_t>(params_.seed), start);
    const std::vector<Cluster> found =
        man ? manClusters(data, count_, seed, control_) : clusters(data, count_, seed, control_);
    const double least =
        params_.leastRadiusVoxels * std::max({data.grid.step.x, data.grid.step.y, data.grid.step.z});
    const auto ballsWith = [&](double spread) {
      std::vector<GridBall> balls;
      balls.reserve(found.size());
      for (const Cluster& c : found)
        balls.push_back({c.centre, std::max(spread * c.spread, least), man ? c.density : 1.0});
      if (man) {
        scaleWeights(data, balls);
      } else if (!solveWeights(data, balls, params_.isSigned, control_.late)) {
        // Without the time for more, one factor for the densities of the clusters.
        for (std::size_t i = 0; i < balls.size(); ++i)
          balls[i].weight = params_.isSigned ? found[i].density : std::max(found[i].density, 0.0);
        scaleWeights(data, balls);
      }
      return balls;
    };
    if (params_.method == FitMethod::kWeights && !params_.spread) {
      double best = 0.0;
      for (const double spread : kSpreads) {
        control_.check();
        if (!begun.empty() && control_.late()) break;
        std::vector<GridBall> balls = ballsWith(spread);
        std::vector<float> r;
        const double squares = residual(data, balls, BallLists(data.grid, balls), r);
        if (begun.empty() || squares < best) best = squares, begun = std::move(balls);
      }
    } else {
      begun = ballsWith(params_.spread.value_or(man ? kManSpread : kFirstSpread));
    }
  }

  void refineOn(std::size_t depth, int steps, double tolerance) {
    RefineParams p = refineParams(depth);
    p.steps = steps, p.tolerance = tolerance;
    const DensityGrid& data = pyramid_[depth];
    squares_ = refine(data, balls_, p, control_);
    relative_ = std::sqrt(squares_ / data.squares);
  }

  // So few balls come so near that the map may be made of them: worth going round minima, as long as some
  // balls more come much nearer. Near the truth overlapping balls want steps that are exact.
  void findAll(std::size_t depth) {
    if (count_ > kFewBalls || relative_ > kNearlyExact) return;
    const DensityGrid& data = pyramid_[depth];
    RefineParams p = refineParams(depth);
    p.steps = kDetourSteps, p.tolerance = 1e-4;
    const int rounds = static_cast<int>(std::lround(params_.effort * kDetourRounds));
    for (int round = 0; round < rounds && relative_ > kExact && !control_.late(); ++round) {
      const bool close = relative_ < kClose;
      if (close) p.innerSteps = kCloseInnerSteps, p.innerTolerance = kCloseInnerTolerance;
      std::vector<GridBall> tried = balls_;
      const double squares = goRound(
          data, tried, {kBallsMore, static_cast<std::size_t>(round), kWorthwhile * squares_}, p, control_);
      if (squares < squares_)
        squares_ = squares, relative_ = std::sqrt(squares / data.squares), balls_ = std::move(tried);
      else if (!close)
        return;
    }
  }

  // Few balls leave threads without work: then several ways to move are tried at once.
  std::vector<Move> movesOf(bool several, double share, std::size_t spared) const {
    const double wanted = std::max(std::round(share * static_cast<double>(count_)), 1.0);
    const auto many = static_cast<std::size_t>(wanted);
    if (!several) return {{many, many > 1 ? 0 : spared, 0}};
    std::vector<Move> moves = {{many, 0, 0}};
    for (std::size_t i = 0; i < kSingleMoves; ++i)
      for (const std::size_t passed : {0, 1}) moves.push_back({1, (spared + i) % count_, passed});
    return moves;
  }

  void moveAbout(std::size_t depth, int rounds) {
    const DensityGrid& data = pyramid_[depth];
    RefineParams p = refineParams(depth);
    p.tolerance = 1e-4;
    const bool several = count_ <= kFewBalls && !BallLists(data.grid, balls_).many();
    p.steps = several ? kFewRoundSteps : kRoundSteps;
    const FitControl quiet{[] {}, control_.late};
    double share = kMovedFirst;
    std::size_t spared = 0;
    for (int round = 0; round < rounds && relative_ > kExact && !control_.late(); ++round, stepDone(1.0)) {
      control_.check();
      const std::vector<Move> moves = movesOf(several, share, spared);
      std::vector<std::vector<GridBall>> tried(moves.size());
      std::vector<double> squares(moves.size(), squares_);
      const auto attempt = [&](std::size_t i, const FitControl& control) {
        tried[i] = relocated(data, balls_, moves[i], p, control);
        if (tried[i].size() == count_) squares[i] = refine(data, tried[i], p, control);
      };
      if (several)
        parallelFor(moves.size(), 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) attempt(i, quiet);
        });
      else
        attempt(0, control_);
      const auto best =
          static_cast<std::size_t>(std::min_element(squares.begin(), squares.end()) - squares.begin());
      if (squares[best] < squares_) {
        squares_ = squares[best];
        relative_ = std::sqrt(squares_ / data.squares);
        balls_ = std::move(tried[best]);
        spared = 0;
      } else {  // the same again would fail again
        share *= kMovedLess;
        if (several)
          spared += kSingleMoves;
        else if (moves[0].count == 1)
          spared = (spared + 1) % count_;
      }
    }
  }

  const std::vector<DensityGrid>& pyramid_;
  const FitParams& params_;
  std::size_t count_;
  std::function<void(double, double)> report_;
  FitControl control_;
  std::vector<GridBall> balls_;
  double squares_ = 0.0, relative_ = 1.0;
  double stepsToDo_ = 1.0, stepsDone_ = 0.0, done_ = 0.0;
};

void measure(const DensityGrid& data, std::span<const GridBall> balls, FitLevel& level) {
  std::vector<float> r;
  const double squares = residual(data, balls, BallLists(data.grid, balls), r);
  level.relativeL2 = std::sqrt(squares / data.squares);
  level.rmse = data.unit * std::sqrt(squares / static_cast<double>(data.voxels()));
}

void validate(const DensityGrid& data, const FitParams& params, const std::vector<FitLevel>& levels) {
  if (params.isSigned && params.method == FitMethod::kMan)
    throw ParameterError("the method man has no signed densities; expected refined or weights");
  if (!params.isSigned && std::ranges::none_of(data.density, [](float d) { return d > 0.0f; }))
    throw ParameterError("the map's density is nowhere above 0; expected some, or a signed fit");
  for (const FitLevel& level : levels) {
    const std::string balls = std::to_string(level.count) + (level.count == 1 ? " ball" : " balls");
    if (level.count < 1) throw ParameterError("a level of 0 balls; expected at least 1");
    if (static_cast<std::int64_t>(level.count) > data.cloudVoxels)
      throw ParameterError(balls + " are more than the map has voxels of cloud; expected at most " +
                           std::to_string(data.cloudVoxels));
    if (level.balls.empty()) continue;
    if (level.balls.size() != level.count)
      throw ParameterError(balls + " cannot go on from " + std::to_string(level.balls.size()));
    field::validate(level.balls);
    for (const field::Metaball& b : level.balls)
      if (b.density < 0.0 && !params.isSigned)
        throw ParameterError("the balls to go on from have negative densities; expected a signed fit");
    const auto meetsMap = [&](const GridBall& b) {
      return gainOfBall(data.grid, b, data.density.data()).ff > 0.0;
    };
    if (!std::ranges::any_of(gridBalls(level.balls, data.unit), meetsMap))
      throw ParameterError("none of the balls to go on from is within the map; expected those of this map");
  }
}

}  // namespace

void describe(FitParams& p, ParamVisitor& v) {
  v.choice({"method", "", "how balls are found"}, p.method);
  v.value({"signed", "", "let densities of balls be negative"}, p.isSigned);
  v.value({"seed", "", "other clusters to begin with", 0, 9007199254740991.0}, p.seed);
  v.value({"spread", "",
           "radius of the first balls, of the RMS radius of their clusters; absent: what is best", 0.1, 20},
          p.spread);
  v.value({"least_radius_voxels", "voxels", "no ball is smaller", 0.5, 1000}, p.leastRadiusVoxels);
  v.value({"effort", "", "factor of the rounds in which balls are moved to where they are missed", 0, 100},
          p.effort);
  v.value({"time_limit_s", "s", "finish after that time with what there is; absent: none", 0, 1e6},
          p.timeLimitS);
}

void fitMetaballs(const Volume<float>& map, const field::VoxelFrame& frame, const FitParams& params,
                  std::vector<FitLevel>& levels, const std::function<void(const FitProgress&)>& progress) {
  const Clock::time_point start = Clock::now();
  std::vector<DensityGrid> pyramid;
  pyramid.push_back(densityGrid(map, frame));
  validate(pyramid[0], params, levels);
  while (params.method == FitMethod::kRefined && pyramid.back().voxels() > kLargeMap)
    pyramid.push_back(coarser(pyramid.back()));
  double ballsLeft = 0.0;
  for (const FitLevel& level : levels) ballsLeft += static_cast<double>(level.count);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    FitLevel& level = levels[i];
    level.complete = false;
    const Clock::time_point begin = Clock::now();
    std::optional<Clock::time_point> end;
    if (params.timeLimitS) {
      const double left = *params.timeLimitS - secondsSince(start);
      const double share = static_cast<double>(level.count) / ballsLeft;
      end = begin + std::chrono::duration_cast<Clock::duration>(
                        std::chrono::duration<double>(std::max(left * share, 0.0)));
    }
    ballsLeft -= static_cast<double>(level.count);
    LevelFit job(pyramid, params, level, end, [&](double fraction, double relative) {
      if (progress) progress({i, fraction, relative});
    });
    const auto finish = [&] {
      if (job.balls().empty()) return;
      level.balls = metaballs(job.balls(), pyramid[0].unit);
      measure(pyramid[0], job.balls(), level);
      level.seconds = secondsSince(begin);
    };
    try {
      job.run();
    } catch (...) {
      finish();
      throw;
    }
    finish();
    level.complete = true;
  }
}

}  // namespace welkin::fit
