// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/cluster.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "welkin/core/parallel.h"
#include "welkin/core/random.h"

namespace welkin::fit {
namespace {

constexpr int kRounds = 15;
constexpr double kAtRest = 1e-3;  // centres that move less than this, of a voxel, are at rest
constexpr std::size_t kGrain = 4096, kEpochGrain = 256;
constexpr int kMostEpochs = 40;
constexpr double kSlowest = 0.02;

struct Point {
  glm::dvec3 at;
  double weight, density;
};

// Three times 21 bits, interleaved.
std::uint64_t spreadBits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

// The voxels that are not 0, along the curve if asked for.
std::vector<Point> pointsOf(const DensityGrid& data, bool alongCurve) {
  struct Keyed {
    std::uint64_t key;
    Point point;
  };
  const BallGrid& grid = data.grid;
  std::vector<Keyed> keyed;
  keyed.reserve(static_cast<std::size_t>(data.cloudVoxels));
  for (int z = 0; z < grid.nz; ++z)
    for (int y = 0; y < grid.ny; ++y)
      for (int x = 0; x < grid.nx; ++x) {
        const float density = data.density[grid.row(y, z) + static_cast<std::size_t>(x)];
        if (density == 0.0f) continue;
        const std::uint64_t key = alongCurve ? spreadBits(static_cast<std::uint64_t>(x)) |
                                                   spreadBits(static_cast<std::uint64_t>(y)) << 1 |
                                                   spreadBits(static_cast<std::uint64_t>(z)) << 2
                                             : keyed.size();
        keyed.push_back({key,
                         {grid.first + glm::dvec3(x, y, z) * grid.step,
                          std::abs(static_cast<double>(density)), static_cast<double>(density)}});
      }
  if (alongCurve)
    std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  std::vector<Point> points;
  points.reserve(keyed.size());
  for (const Keyed& k : keyed) points.push_back(k.point);
  return points;
}

// `count` different points at equal steps of the weight.
std::vector<glm::dvec3> spreadCentres(const std::vector<Point>& points, std::size_t count,
                                      std::uint64_t seed) {
  double total = 0.0;
  for (const Point& p : points) total += p.weight;
  const double step = total / static_cast<double>(count);
  const double shift = Random(hashOf(seed, 0x636c7573)).uniform();
  std::vector<glm::dvec3> centres;
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size() && centres.size() < count; ++i) {
    sum += points[i].weight;
    const std::size_t wanted = count - centres.size(), left = points.size() - i;
    if (sum > (static_cast<double>(centres.size()) + shift) * step || wanted == left)
      centres.push_back(points[i].at);
  }
  assert(centres.size() == count);
  return centres;
}

// Centres in bins, for the nearest of them.
class NearestCentre {
 public:
  explicit NearestCentre(const std::vector<glm::dvec3>& centres) : centres_(centres) {
    low_ = glm::dvec3(std::numeric_limits<double>::max());
    glm::dvec3 high(std::numeric_limits<double>::lowest());
    for (const glm::dvec3& c : centres) low_ = glm::min(low_, c), high = glm::max(high, c);
    const glm::dvec3 size = glm::max(high - low_, glm::dvec3(1e-9));
    const double largest = std::max({size.x, size.y, size.z});
    const double bin =
        std::max(std::cbrt(size.x * size.y * size.z / static_cast<double>(centres.size())), largest / 128.0);
    for (int a = 0; a < 3; ++a) {
      bins_[a] = static_cast<int>(std::clamp(std::ceil(size[a] / bin), 1.0, 128.0));
      perMetre_[a] = bins_[a] / size[a];
    }
    begins_.assign(static_cast<std::size_t>(bins_.x) * bins_.y * bins_.z + 1, 0);
    for (const glm::dvec3& c : centres) ++begins_[binIndex(binOf(c)) + 1];
    for (std::size_t n = 1; n < begins_.size(); ++n) begins_[n] += begins_[n - 1];
    members_.resize(centres.size());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < centres.size(); ++i)
      members_[next[binIndex(binOf(centres[i]))]++] = static_cast<std::uint32_t>(i);
  }

  // The nearest, of several the first; `guess` bounds the search.
  std::uint32_t operator()(const glm::dvec3& p, std::uint32_t guess) const {
    double best = square(p - centres_[guess]);
    std::uint32_t nearest = guess;
    const double reach = std::sqrt(best);
    const glm::ivec3 low = binOf(p - reach), high = binOf(p + reach);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::size_t n = binIndex({x, y, z});
          for (std::uint32_t m = begins_[n]; m < begins_[n + 1]; ++m) {
            const std::uint32_t i = members_[m];
            const double distance = square(p - centres_[i]);
            if (distance < best || (distance == best && i < nearest)) best = distance, nearest = i;
          }
        }
    return nearest;
  }

 private:
  glm::ivec3 binOf(const glm::dvec3& p) const {
    return glm::ivec3(glm::clamp((p - low_) * perMetre_, glm::dvec3(0.0), glm::dvec3(bins_ - 1)));
  }
  std::size_t binIndex(const glm::ivec3& b) const {
    return (static_cast<std::size_t>(b.z) * bins_.y + b.y) * bins_.x + b.x;
  }

  const std::vector<glm::dvec3>& centres_;
  glm::dvec3 low_, perMetre_;
  glm::ivec3 bins_;
  std::vector<std::uint32_t> begins_, members_;
};

std::vector<Cluster> clustersOf(const std::vector<Point>& points, const std::vector<std::uint32_t>& owner,
                                const std::vector<glm::dvec3>& centres) {
  struct Sums {
    double squares = 0.0, weight = 0.0, density = 0.0, count = 0.0;
  };
  std::vector<Sums> sums(centres.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Sums& s = sums[owner[i]];
    s.squares += points[i].weight * square(points[i].at - centres[owner[i]]);
    s.weight += points[i].weight;
    s.density += points[i].density;
    s.count += 1.0;
  }
  std::vector<Cluster> found(centres.size());
  for (std::size_t k = 0; k < centres.size(); ++k) {
    found[k].centre = centres[k];
    if (sums[k].count == 0.0) continue;
    found[k].spread = std::sqrt(sums[k].squares / sums[k].weight);
    found[k].density = sums[k].density / sums[k].count;
  }
  return found;
}

}  // namespace

std::vector<Cluster> clusters(const DensityGrid& data, std::size_t count, std::uint64_t seed,
                              const FitControl& control) {
  assert(count >= 1 && static_cast<std::int64_t>(count) <= data.cloudVoxels);
  const std::vector<Point> points = pointsOf(data, true);
  std::vector<glm::dvec3> centres = spreadCentres(points, count, seed);
  std::vector<std::uint32_t> owner(points.size(), 0);
  // Points follow the curve, and so do the first centres: a guess that is near.
  for (std::size_t i = 0; i < points.size(); ++i)
    owner[i] = static_cast<std::uint32_t>(i * count / points.size());
  const double rest = kAtRest * std::min({data.grid.step.x, data.grid.step.y, data.grid.step.z});
  for (int round = 0;; ++round) {
    control.check();
    const NearestCentre nearest(centres);
    parallelFor(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) owner[i] = nearest(points[i].at, owner[i]);
    });
    if (round == kRounds || control.late()) break;
    std::vector<glm::dvec3> sums(count, glm::dvec3(0.0));
    std::vector<double> weights(count);
    for (std::size_t i = 0; i < points.size(); ++i) {
      sums[owner[i]] += points[i].weight * points[i].at;
      weights[owner[i]] += points[i].weight;
    }
    double farthest = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      if (weights[k] <= 0.0) continue;
      const glm::dvec3 mean = sums[k] / weights[k];
      farthest = std::max(farthest, square(mean - centres[k]));
      centres[k] = mean;
    }
    if (farthest < rest * rest) break;
  }
  return clustersOf(points, owner, centres);
}

std::vector<Cluster> manClusters(const DensityGrid& data, std::size_t count, std::uint64_t seed,
                                 const FitControl& control) {
  assert(count >= 1 && static_cast<std::int64_t>(count) <= data.cloudVoxels);
  std::vector<Point> points = pointsOf(data, false);
  for (Point& p : points) p.weight = 1.0;
  Random random(hashOf(seed, 0x6d616e));
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  const auto shuffle = [&] {
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
  };
  shuffle();
  std::vector<glm::dvec3> centres;
  centres.reserve(count);
  for (std::size_t k = 0; k < count; ++k) centres.push_back(points[order[k]].at);
  const auto nearestTo = [&](const glm::dvec3& p) {
    std::size_t nearest = 0;
    double best = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < count; ++k) {
      const double distance = square(p - centres[k]);
      if (distance < best) best = distance, nearest = k;
    }
    return nearest;
  };
  std::vector<std::uint64_t> drawn(count, 0);
  bool late = false;
  for (int epoch = 0; epoch < kMostEpochs && !late; ++epoch) {
    shuffle();
    for (std::size_t i = 0; i < order.size() && !late; ++i) {
      if (i % kEpochGrain == 0) {
        control.check();
        late = control.late();
      }
      const glm::dvec3& p = points[order[i]].at;
      const std::size_t k = nearestTo(p);
      centres[k] += (p - centres[k]) / std::sqrt(static_cast<double>(++drawn[k]));
    }
    double eta = 0.0;
    for (const std::uint64_t n : drawn)
      eta += 1.0 / std::sqrt(static_cast<double>(std::max<std::uint64_t>(n, 1)));
    if (eta / static_cast<double>(count) < kSlowest) break;
  }
  std::vector<std::uint32_t> owner(points.size());
  const NearestCentre nearest(centres);
  parallelFor(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::uint32_t guess = 0;  // voxels that follow one another lie near one another
    for (std::size_t i = begin; i < end; ++i) owner[i] = guess = nearest(points[i].at, guess);
  });
  return clustersOf(points, owner, centres);
}

}  // namespace welkin::fit
