// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/metaball_layer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/field/cover.h"
#include "welkin/scene/cumulus_library.h"

namespace welkin::scene {
namespace {

constexpr double kFlatBelowM = 600.0;  // layers thinner than that have flat clouds
constexpr double kCellShare = 0.66;    // of the widest cloud
constexpr double kLeastSize = 0.3;     // of the largest cloud
constexpr double kReach = 45.0;        // widths of the widest cloud
constexpr double kLeastReachM = 10000.0, kMostReachM = 45000.0;
constexpr double kFarBases = 20.0;                           // heights of the base, of layers that cover more
constexpr double kClosest = 0.4;                             // of the cells' size
constexpr std::int64_t kGroup = 5;                           // cells along the side of a group's square
constexpr double kPull = 0.9;                                // the most, of the way to the group's middle
constexpr double kLong = 0.5;                                // of that, what is not gone along the group
constexpr double kMostClouds = 30000.0, kMostFar = 14000.0;  // where they stand closer, and else
constexpr double kClosed = 0.97;                             // share of the sky that is as good as all of it
constexpr double kMuch = 3.0;                                // of fill()
constexpr double kShort = 0.4;                               // oktas that are no matter
constexpr double kCycleS = 4800.0;                           // in which a cell's rank goes up and down once
constexpr double kYoung = 0.35;  // share of the threshold over which a cloud grows up
constexpr int kDirections = 1200, kBisections = 14;
constexpr double kMeasuredM = 2.0;  // height of the eye

double widestM(const weather::Layer& layer, const std::vector<LibraryCloud>& library) {
  return (layer.topM - layer.baseM) / library[0].height;
}

const std::vector<LibraryCloud>& libraryOf(bool flat) {
  return flat ? flatCumulus() : cumulusTowers();
}

std::int64_t groupOf(std::int64_t cell) {
  return cell >= 0 ? cell / kGroup : -((kGroup - 1 - cell) / kGroup);
}

// Where clouds gather, in cells, and how large they are there.
struct Group {
  glm::dvec2 middle{0.0};
  double vigour = 0.0;         // [0, 1]
  glm::dvec2 along{1.0, 0.0};  // unit; they are longer than broad

  // Of a place drawn to the middle by a share of the way.
  glm::dvec2 drawn(const glm::dvec2& at, double share) const {
    const glm::dvec2 away = at - middle;
    return middle + (1.0 - share) * away + (kLong * share * glm::dot(away, along)) * along;
  }
};
Group groupAt(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  Random random(hashOf(seed, 0x67726f7570, i, j));
  const double x = static_cast<double>(i) + random.uniform(), y = static_cast<double>(j) + random.uniform();
  const double vigour = random.uniform(), angle = 2.0 * kPi * random.uniform();
  return {static_cast<double>(kGroup) * glm::dvec2(x, y), vigour, {std::cos(angle), std::sin(angle)}};
}

}  // namespace

glm::dvec3 overEarth(const glm::dvec3& p, const glm::dvec3& eyeM, double earthRadiusM) {
  const glm::dvec2 d(p.x - eyeM.x, p.y - eyeM.y);
  const double along = std::hypot(d.x, d.y), angle = along / earthRadiusM;
  if (along < 1.0) return p;
  const double out = (earthRadiusM + p.z) * std::sin(angle), half = std::sin(0.5 * angle);
  return {eyeM.x + d.x / along * out, eyeM.y + d.y / along * out,
          p.z - 2.0 * half * half * (earthRadiusM + p.z)};
}

field::Metaball placed(const field::Metaball& ball, const MetaballLayer::Cloud& cloud) {
  const double c = std::cos(cloud.turnRad), s = std::sin(cloud.turnRad);
  const glm::dvec3 p = cloud.widthM * ball.centreM;
  return {cloud.baseM + glm::dvec3(c * p.x + s * p.y, c * p.y - s * p.x, p.z), cloud.widthM * ball.radiusM,
          cloud.extinctionPerM * ball.density};
}

MetaballLayer::MetaballLayer(const weather::Layer& layer, std::uint64_t seed, double earthRadiusM)
    : layer_(layer), seed_(seed), earthRadiusM_(earthRadiusM), flat_(layer.topM - layer.baseM < kFlatBelowM) {
  if (layer.oktas <= 0.0) return;
  const double wanted = std::min(layer.oktas / 8.0, kClosed);
  const auto coverWith = [&](double much) {
    fill(much);
    return field::coverOf(opticalDepths(0.0, glm::dvec2(0.0), kDirections));
  };
  double low = 0.0, high = kMuch;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (coverWith(middle) < wanted ? low : high) = middle;
  }
  const double most = coverWith(high);
  if (high == kMuch && 8.0 * most < layer.oktas - kShort) mostOktas_ = 8.0 * most;
}

// Up to 1 in more and more cells, up to 2 larger and farther out, up to 3 closer.
void MetaballLayer::fill(double much) {
  const double larger = std::clamp(much - 1.0, 0.0, 1.0), closer = std::clamp(much - 2.0, 0.0, 1.0);
  threshold_ = std::min(much, 1.0) / (1.0 - kYoung);  // at 1 every cloud is grown up
  leastSize_ = glm::mix(kLeastSize, 1.0, larger);
  pull_ = kPull * (1.0 - larger);
  const double widthM = widestM(layer_, library());
  cellM_ = kCellShare * widthM;
  const auto reachOf = [&](double clouds) { return cellM_ * std::sqrt(clouds / kPi); };
  const double nearM = std::clamp(kReach * widthM, kLeastReachM, kMostReachM);
  const double farM = std::min({kFarBases * layer_.baseM, kMostReachM, reachOf(kMostFar)});
  reachM_ = glm::mix(nearM, std::max(nearM, farM), larger);
  const double closest = std::clamp(reachM_ / reachOf(kMostClouds), kClosest, 1.0);
  cellM_ *= glm::mix(1.0, closest, closer);
}

const std::vector<LibraryCloud>& MetaballLayer::library() const {
  return libraryOf(flat_);
}

void MetaballLayer::cloudsAt(double secondsAfter, const glm::dvec2& driftedM, const glm::dvec2& eyeM,
                             std::vector<Cloud>& out) const {
  out.clear();
  if (threshold_ <= 0.0) return;
  const double widthM = widestM(layer_, library());
  const glm::dvec2 middle = (eyeM - driftedM) / cellM_;
  const double reach = reachM_ / cellM_;
  // Of cells whose clouds may be drawn in.
  const double seek = reach + static_cast<double>(kGroup) * pull_;
  const auto from = [&](double at) { return static_cast<std::int64_t>(std::floor(at - seek)); };
  for (std::int64_t j = from(middle.y); static_cast<double>(j) <= middle.y + seek; ++j)
    for (std::int64_t i = from(middle.x); static_cast<double>(i) <= middle.x + seek; ++i) {
      Random random(hashOf(seed_, 0x6c61, i, j));
      glm::dvec2 at{static_cast<double>(i) + random.uniform(), static_cast<double>(j) + random.uniform()};
      const Group group = groupAt(seed_, groupOf(i), groupOf(j));
      // Some all the way, others hardly.
      at = group.drawn(at, pull_ * (0.6 + 0.4 * group.vigour) * random.uniform());
      // Up and down again, at a pace of its own.
      const double cycles = secondsAfter / kCycleS * (0.7 + 0.6 * random.uniform()) + random.uniform();
      const double rank = std::abs(2.0 * (cycles - std::floor(cycles)) - 1.0);
      const double age = (threshold_ - rank) / (kYoung * threshold_);
      if (age <= 0.0 || glm::length(at - middle) > reach) continue;
      Cloud cloud;
      cloud.baseM = {at.x * cellM_ + driftedM.x, at.y * cellM_ + driftedM.y, layer_.baseM};
      // Many small ones for each large one, of which most stand together.
      const double u = std::min(random.uniform() * (0.45 + 0.65 * group.vigour), 1.0);
      cloud.widthM =
          widthM * (leastSize_ + (1.0 - leastSize_) * u * u) * (0.4 + 0.6 * glm::smoothstep(0.0, 1.0, age));
      cloud.turnRad = 2.0 * kPi * random.uniform();
      cloud.shape = random.below(static_cast<std::uint32_t>(library().size()));
      cloud.extinctionPerM = layer_.extinctionPerM * glm::smoothstep(0.0, 1.0, 3.0 * age);
      out.push_back(cloud);
    }
}

std::vector<float> MetaballLayer::opticalDepths(double secondsAfter, const glm::dvec2& driftedM,
                                                int directions) const {
  constexpr std::size_t kLevel = 1;
  std::vector<Cloud> clouds;
  cloudsAt(secondsAfter, driftedM, glm::dvec2(0.0), clouds);
  const glm::dvec3 eye(0.0, 0.0, kMeasuredM);
  // As they are drawn: over the curved earth.
  struct Seen {
    glm::dvec3 middle;
    double radiusM;
    std::size_t begin, end;
  };
  std::vector<Seen> seen;
  std::vector<field::Metaball> all;
  for (const Cloud& cloud : clouds) {
    const std::size_t begin = all.size();
    for (const field::Metaball& b : shape(cloud).levels[kLevel]) {
      all.push_back(placed(b, cloud));
      all.back().centreM = overEarth(all.back().centreM, eye, earthRadiusM_);
    }
    const field::Box box = field::boundsOf(std::span(all).subspan(begin));
    seen.push_back(
        {0.5 * (box.low + box.high) - eye, 0.5 * glm::length(box.high - box.low), begin, all.size()});
  }
  std::vector<float> depths(static_cast<std::size_t>(directions));
  parallelFor(depths.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t d = first; d < last; ++d) {
      const glm::dvec3 dir(field::hemisphereDirection(static_cast<int>(d), directions));
      double depth = 0.0;
      for (const Seen& s : seen) {
        const double along = glm::dot(s.middle, dir);
        if (along < -s.radiusM || glm::dot(s.middle, s.middle) - along * along > s.radiusM * s.radiusM)
          continue;
        for (std::size_t i = s.begin; i < s.end; ++i) depth += field::columnAlong(all[i], eye, dir);
        if (depth > field::kCoverOpticalDepth) break;
      }
      depths[d] = static_cast<float>(depth);
    }
  });
  return depths;
}

}  // namespace welkin::scene
