// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cumulus_tower.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/random.h"

namespace welkin::field {
namespace {

constexpr std::size_t kMostBubbles = 10000;
// A child starts where its parent is already thin, and is left out where another bubble hides it.
constexpr double kSeat = 0.8, kHidden = 0.55;
const double kGoldenAngle = std::numbers::pi * (3.0 - std::sqrt(5.0));

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

// The first generation: a core as high as the tower and lower bubbles around it, all rooted at the base.
std::vector<Ellipsoid> rootBubbles(const CumulusParams& p, Random& random) {
  std::vector<Ellipsoid> bubbles;
  const double start = between(random, 0.0, 2.0 * std::numbers::pi);
  for (std::int64_t i = 0; i < p.bubbles; ++i) {
    const bool core = i == 0;
    const double radius = p.widthM * (core ? between(random, 0.27, 0.32) : between(random, 0.14, 0.24));
    const double height = p.heightM * (core ? 0.9 : between(random, 0.3, 0.7));
    const double away = core ? 0.0 : p.widthM * between(random, 0.2, 0.32);
    const double angle = start + kGoldenAngle * static_cast<double>(i) + between(random, -0.3, 0.3);
    // Rooted a little above the base, so that the widest part is low.
    const double foot = 0.3 * std::min(radius, height);
    bubbles.push_back({{away * std::cos(angle), away * std::sin(angle), foot},
                       {radius, radius, std::max(height - foot, 0.5 * radius)},
                       glm::dvec3(0.0)});
  }
  return bubbles;
}

// Bubbles on one parent, in directions spread evenly but for the side below.
void growOn(const Ellipsoid& parent, const CumulusParams& p, std::span<const EllipsoidForm> others,
            Random& random, std::vector<Ellipsoid>& out) {
  const double least = std::min({parent.radiiM.x, parent.radiiM.y, parent.radiiM.z});
  // Long parents have more room.
  const double slender = std::max(1.0, parent.radiiM.z / least);
  const auto count = static_cast<std::int64_t>(std::ceil(static_cast<double>(p.children) * slender));
  const double start = between(random, 0.0, 2.0 * std::numbers::pi);
  for (std::int64_t i = 0; i < count; ++i) {
    const double up =
        1.0 - 1.25 * (static_cast<double>(i) + between(random, 0.0, 1.0)) / static_cast<double>(count);
    const double angle = start + kGoldenAngle * static_cast<double>(i);
    const double side = std::sqrt(std::max(0.0, 1.0 - up * up));
    const double radius = least * p.ratio * between(random, 0.75, 1.2);
    const glm::dvec3 direction(side * std::cos(angle), side * std::sin(angle), up);
    const glm::dvec3 seat = parent.centreM + kSeat * parent.radiiM * direction;
    if (seat.z < 0.3 * radius) continue;
    const bool hidden = std::any_of(others.begin(), others.end(),
                                    [&](const EllipsoidForm& other) { return other.q(seat) > kHidden; });
    if (!hidden) out.push_back({seat, glm::dvec3(radius), glm::dvec3(0.0)});
  }
}

// Centres moved downwind with height, then the whole stretched to the size asked for.
void fit(std::vector<Ellipsoid>& bubbles, const CumulusParams& p) {
  for (Ellipsoid& b : bubbles) {
    const double rise = std::max(b.centreM.z, 0.0) / p.heightM;
    b.centreM.x += p.lean * p.heightM * rise * rise;
  }
  const Box box = boundsOf(bubbles);
  const glm::dvec3 scale(p.widthM / (box.high.x - box.low.x), p.widthM / (box.high.y - box.low.y),
                         p.heightM / box.high.z);
  const glm::dvec3 middle(0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y), 0.0);
  for (Ellipsoid& b : bubbles) {
    b.centreM = (b.centreM - middle) * scale;
    b.radiiM *= scale;
  }
}

}  // namespace

void describe(CumulusParams& p, ParamVisitor& v) {
  v.value({"tower_seed", "", "another tower of the same kind", 0, 9007199254740991.0}, p.seed);
  v.value({"width_m", "m", "width of the tower", 1, 100000}, p.widthM);
  v.value({"height_m", "m", "height of the tower above its base", 1, 30000}, p.heightM);
  v.value({"bubbles", "", "bubbles that rise from the base", 1, 64}, p.bubbles);
  v.value({"generations", "", "how often bubbles grow on bubbles, the first ones counted", 1, 6},
          p.generations);
  v.value({"children", "", "bubbles tried on each bubble", 1, 64}, p.children);
  v.value({"ratio", "", "radius of a bubble, of the one it grows on", 0.1, 0.9}, p.ratio);
  v.value({"lean", "", "how far east the top leans, of the height", -2, 2}, p.lean);
}

std::vector<Ellipsoid> cumulusTower(const CumulusParams& p) {
  Random random(hashOf(static_cast<std::uint64_t>(p.seed), 0x746f776572));
  std::vector<Ellipsoid> bubbles = rootBubbles(p, random);
  std::size_t begin = 0;
  for (std::int64_t generation = 1; generation < p.generations; ++generation) {
    const std::vector<EllipsoidForm> grown(bubbles.begin(), bubbles.end());
    const std::size_t end = bubbles.size();
    for (std::size_t i = begin; i < end; ++i) {
      const Ellipsoid parent = bubbles[i];
      growOn(parent, p, grown, random, bubbles);
      if (bubbles.size() > kMostBubbles)
        throw ParameterError("the tower needs more than " + std::to_string(kMostBubbles) +
                             " bubbles; expected fewer children or generations");
    }
    begin = end;
  }
  fit(bubbles, p);
  return bubbles;
}

void fitBox(CloudMapParams& map, std::span<const Ellipsoid> ellipsoids) {
  constexpr double kMargin = 1.05, kMost = 65536.0;
  const Box box = boundsOf(ellipsoids);
  const glm::dvec3 reach = glm::max(glm::abs(box.low), glm::abs(box.high));
  const glm::dvec3 sizeM(2.0 * reach.x, 2.0 * reach.y, box.high.z);
  std::int64_t* const sizes[] = {&map.nx, &map.ny, &map.nz};
  for (int axis = 0; axis < 3; ++axis)
    *sizes[axis] =
        static_cast<std::int64_t>(std::clamp(std::ceil(kMargin * sizeM[axis] / map.voxelM), 1.0, kMost));
}

CloudMapParams cumulusMap(const CumulusParams& p, double voxelM) {
  CloudMapParams map;
  map.voxelM = voxelM;
  map.threshold = 0.25;
  map.noise = {.kind = MapNoiseKind::kPerlin,
               .octaves = 5,
               .cellVoxels = std::max(p.widthM / (6.0 * voxelM), 1.0),
               .fold = MapFold::kShifted};
  fitBox(map, cumulusTower(p));
  return map;
}

}  // namespace welkin::field
