// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/metaball_medium.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <mutex>
#include <numeric>

#include "welkin/reference/directions.h"

namespace welkin::reference {
namespace {

constexpr double kBrickShare = 0.5;  // of the balls' median radius
constexpr int kMostBricks = 64;      // on an axis
constexpr double kMargin = 1e-3;     // by which a brick is taken to be wider, in bricks
// What is left of a transmittance goes on with a chance below this share.
constexpr double kRouletteBelow = 0.1, kRouletteTo = 0.25;
constexpr std::size_t kDeepest = 64;  // of the tree

double freeDepth(Random& random) {
  return -std::log1p(-unit(random));
}

// The stretch of a ray in a box; near >= far: none.
void stretchIn(const field::Box& box, const Ray& ray, double& near, double& far) {
  for (int k = 0; k < 3; ++k) {
    if (ray.way[k] == 0.0) {
      if (ray.from[k] < box.low[k] || ray.from[k] > box.high[k]) far = near;
      continue;
    }
    const double a = (box.low[k] - ray.from[k]) / ray.way[k], b = (box.high[k] - ray.from[k]) / ray.way[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
}

double lengthSquared(const glm::dvec3& v) {
  return glm::dot(v, v);
}

}  // namespace

class MetaballMedium::Cloud {
 public:
  Cloud(std::span<const field::Metaball> balls, scene::MetaballPhase how, double share)
      : phase(how), albedo(share), box(field::boundsOf(balls)), balls_(balls.begin(), balls.end()) {}

  const scene::MetaballPhase phase;
  const double albedo;
  const field::Box box;

  double extinction(const glm::dvec3& p) const {
    const std::optional<std::size_t> brick = brickAt(p);
    return brick ? extinctionIn(*brick, p) : 0.0;
  }
  double majorant(const glm::dvec3& p) const {
    const std::optional<std::size_t> brick = brickAt(p);
    return brick ? grid().majorants[*brick] : 0.0;
  }

  // Calls f(t, extinction, majorant) at tentative collisions along [t0, t1), which lies in the box, until it
  // returns true.
  template <class F>
  void track(const Ray& ray, double t0, double t1, Random& random, F&& f) const {
    const Grid& g = grid();
    const glm::dvec3 at = (ray.at(t0) - box.low) / g.brickM, slope = ray.way / g.brickM;
    glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(at)), glm::ivec3(0), g.bricks - 1);
    glm::dvec3 next(1e300), step(0.0);  // t at which each axis leaves the brick, and from brick to brick
    for (int k = 0; k < 3; ++k) {
      if (slope[k] == 0.0) continue;
      step[k] = 1.0 / std::abs(slope[k]);
      next[k] = t0 + ((slope[k] > 0.0 ? cell[k] + 1 : cell[k]) - at[k]) / slope[k];
    }
    double depth = freeDepth(random);
    for (double t = t0; t < t1;) {
      const int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
      const double out = std::min(next[axis], t1);
      const std::size_t brick = g.index(cell);
      const double majorant = g.majorants[brick];
      while (majorant > 0.0) {
        const double on = depth / majorant;
        if (t + on >= out) {
          depth -= std::max(out - t, 0.0) * majorant;
          break;
        }
        t += on;
        depth = freeDepth(random);
        if (f(t, extinctionIn(brick, ray.at(t)), majorant)) return;
      }
      t = std::max(t, out);
      cell[axis] += slope[axis] > 0.0 ? 1 : -1;
      if (cell[axis] < 0 || cell[axis] >= g.bricks[axis]) return;
      next[axis] += step[axis];
    }
  }

 private:
  struct Member {
    glm::dvec3 centreM;
    double perSquare, density;  // 1 / R^2
  };
  struct Grid {
    glm::ivec3 bricks{1};
    glm::dvec3 brickM{1.0};
    std::vector<std::uint32_t> begins;  // of each brick's part of members
    std::vector<Member> members;
    std::vector<double> majorants;
    std::size_t index(const glm::ivec3& c) const {
      return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(bricks.y) +
              static_cast<std::size_t>(c.y)) *
                 static_cast<std::size_t>(bricks.x) +
             static_cast<std::size_t>(c.x);
    }
  };

  const Grid& grid() const {
    std::call_once(made_, [this] { make(); });
    return grid_;
  }
  std::optional<std::size_t> brickAt(const glm::dvec3& p) const {
    for (int k = 0; k < 3; ++k)
      if (!(p[k] >= box.low[k] && p[k] <= box.high[k])) return {};
    const Grid& g = grid();
    return g.index(glm::clamp(glm::ivec3((p - box.low) / g.brickM), glm::ivec3(0), g.bricks - 1));
  }
  double extinctionIn(std::size_t brick, const glm::dvec3& p) const {
    double sum = 0.0;
    for (std::uint32_t m = grid_.begins[brick]; m < grid_.begins[brick + 1]; ++m) {
      const Member& b = grid_.members[m];
      sum += b.density * field::wyvillOfSquare(lengthSquared(p - b.centreM) * b.perSquare);
    }
    return std::max(sum, 0.0);
  }
  void make() const;

  std::vector<field::Metaball> balls_;
  mutable std::once_flag made_;
  mutable Grid grid_;
};

// Counted, then filled.
void MetaballMedium::Cloud::make() const {
  const double brickM = kBrickShare * field::medianRadiusOf(balls_);
  const glm::dvec3 size = box.high - box.low;
  for (int k = 0; k < 3; ++k) {
    grid_.bricks[k] = static_cast<int>(std::clamp(std::ceil(size[k] / brickM), 1.0, double{kMostBricks}));
    grid_.brickM[k] = size[k] / grid_.bricks[k];
  }
  const auto overBricks = [this](const auto& each) {
    for (const field::Metaball& b : balls_) {
      const auto cellOf = [&](const glm::dvec3& p) {
        return glm::clamp(glm::ivec3(glm::floor((p - box.low) / grid_.brickM)), glm::ivec3(0),
                          grid_.bricks - 1);
      };
      const glm::ivec3 low = cellOf(b.centreM - b.radiusM - kMargin * grid_.brickM),
                       high = cellOf(b.centreM + b.radiusM + kMargin * grid_.brickM);
      glm::ivec3 c;
      for (c.z = low.z; c.z <= high.z; ++c.z)
        for (c.y = low.y; c.y <= high.y; ++c.y)
          for (c.x = low.x; c.x <= high.x; ++c.x) {
            const glm::dvec3 from = box.low + (glm::dvec3(c) - kMargin) * grid_.brickM,
                             to = box.low + (glm::dvec3(c) + 1.0 + kMargin) * grid_.brickM;
            const double nearest = lengthSquared(glm::clamp(b.centreM, from, to) - b.centreM);
            const double square = b.radiusM * b.radiusM;
            if (nearest >= square) continue;
            const double farthest =
                lengthSquared(glm::max(glm::abs(from - b.centreM), glm::abs(to - b.centreM)));
            each(grid_.index(c), b,
                 b.density * field::wyvillOfSquare((b.density > 0.0 ? nearest : farthest) / square));
          }
    }
  };
  const auto count = static_cast<std::size_t>(grid_.bricks.x) * static_cast<std::size_t>(grid_.bricks.y) *
                     static_cast<std::size_t>(grid_.bricks.z);
  grid_.begins.assign(count + 1, 0);
  grid_.majorants.assign(count, 0.0);
  overBricks([this](std::size_t brick, const field::Metaball&, double most) {
    ++grid_.begins[brick + 1];
    grid_.majorants[brick] += most;
  });
  for (double& m : grid_.majorants) m = std::max(m, 0.0);
  std::partial_sum(grid_.begins.begin(), grid_.begins.end(), grid_.begins.begin());
  grid_.members.resize(grid_.begins.back());
  std::vector<std::uint32_t> next(grid_.begins.begin(), grid_.begins.end() - 1);
  overBricks([&](std::size_t brick, const field::Metaball& b, double) {
    grid_.members[next[brick]++] = {b.centreM, 1.0 / (b.radiusM * b.radiusM), b.density};
  });
}

MetaballMedium::~MetaballMedium() = default;
MetaballMedium::MetaballMedium(MetaballMedium&&) noexcept = default;

MetaballMedium::MetaballMedium(const scene::CloudBalls& balls) {
  std::vector<field::Metaball> own;
  for (std::size_t i = 0; i < balls.clouds.size(); ++i) {
    own.clear();
    for (const field::Metaball& b : balls.ballsOf(i))
      if (b.density != 0.0 && b.radiusM > 0.0) own.push_back(b);
    if (!own.empty())
      clouds_.push_back(
          std::make_unique<Cloud>(own, balls.clouds[i].phase, static_cast<double>(balls.clouds[i].albedo)));
  }
  if (clouds_.empty()) return;
  std::vector<std::uint32_t> order(clouds_.size());
  std::iota(order.begin(), order.end(), 0u);
  addNode(order, 0, order.size());
}

// Halves by the clouds' middles along the longest side.
std::uint32_t MetaballMedium::addNode(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end) {
  const auto own = static_cast<std::uint32_t>(nodes_.size());
  Node node{clouds_[order[begin]]->box, 0, order[begin]};
  for (std::size_t i = begin; i < end; ++i) {
    node.box.low = glm::min(node.box.low, clouds_[order[i]]->box.low);
    node.box.high = glm::max(node.box.high, clouds_[order[i]]->box.high);
  }
  nodes_.push_back(node);
  if (end - begin == 1) return own;
  const glm::dvec3 size = node.box.high - node.box.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = [&](std::uint32_t i) { return clouds_[i]->box.low[axis] + clouds_[i]->box.high[axis]; };
  std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
            order.begin() + static_cast<std::ptrdiff_t>(end), [&](std::uint32_t a, std::uint32_t b) {
              return middle(a) != middle(b) ? middle(a) < middle(b) : a < b;
            });
  const std::size_t half = begin + (end - begin) / 2;
  addNode(order, begin, half);
  const std::uint32_t right = addNode(order, half, end);
  nodes_[own].right = right;
  return own;
}

template <class F>
void MetaballMedium::each(const Ray& ray, double end, F&& f) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, kDeepest> stack{};
  std::size_t held = 1;
  while (held > 0) {
    const std::uint32_t i = stack[--held];
    const Node& node = nodes_[i];
    double near = 0.0, far = end;
    stretchIn(node.box, ray, near, far);
    if (near >= far) continue;
    if (node.right == 0) {
      end = f(*clouds_[node.cloud], near, far);
      if (end <= 0.0) return;
      continue;
    }
    stack[held++] = node.right;
    stack[held++] = i + 1;
  }
}

std::optional<MetaballMedium::Collision> MetaballMedium::collide(const Ray& ray, double end,
                                                                 Random& random) const {
  std::optional<Collision> collision;
  each(ray, end, [&](const Cloud& cloud, double t0, double t1) {
    cloud.track(ray, t0, t1, random, [&](double t, double extinction, double majorant) {
      if (unit(random) * majorant >= extinction) return false;
      collision = {t, cloud.phase, cloud.albedo};
      end = t;
      return true;
    });
    return end;
  });
  return collision;
}

double MetaballMedium::transmittance(const Ray& ray, double end, Random& random) const {
  double through = 1.0;
  each(ray, end, [&](const Cloud& cloud, double t0, double t1) {
    cloud.track(ray, t0, t1, random, [&](double, double extinction, double majorant) {
      through *= std::max(1.0 - extinction / majorant, 0.0);
      if (through >= kRouletteBelow) return false;
      through = unit(random) * kRouletteTo < through ? kRouletteTo : 0.0;
      return through == 0.0;
    });
    return through == 0.0 ? 0.0 : end;
  });
  return through;
}

double MetaballMedium::extinction(const glm::dvec3& p) const {
  double sum = 0.0;
  for (const auto& cloud : clouds_) sum += cloud->extinction(p);
  return sum;
}

double MetaballMedium::majorant(const glm::dvec3& p) const {
  double sum = 0.0;
  for (const auto& cloud : clouds_) sum += cloud->majorant(p);
  return sum;
}

}  // namespace welkin::reference
