// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/metaball_cumulus.h"

#include <algorithm>
#include <cmath>

namespace welkin::field {
namespace {

// f(a) = 1/5 at a = 0.71.
constexpr double kReach = 1.0 / 0.71;
// How much of a ball's radius may lie below the base: f is less than 1/20 there.
constexpr double kBelow = 1.0 - 0.85;
constexpr int kRounds = 12;

void addBubble(const Ellipsoid& e, std::vector<Metaball>& balls) {
  const double narrow = std::min({e.radiiM.x, e.radiiM.y, e.radiiM.z});
  const double longest = std::max({e.radiiM.x, e.radiiM.y, e.radiiM.z});
  glm::dvec3 axis(0.0);
  for (int i = 0; i < 3; ++i)
    if (e.radiiM[i] == longest) axis = glm::dvec3(i == 0, i == 1, i == 2);
  axis = frameFromEllipsoid(e) * axis;
  const double room = longest - narrow;
  const int steps = static_cast<int>(std::ceil(room / (0.5 * narrow)));
  for (int i = -steps; i <= steps; i += 2) {
    const glm::dvec3 centre = e.centreM + (steps > 0 ? room * i / steps : 0.0) * axis;
    balls.push_back({centre, narrow * kReach, 1.0});
  }
}

}  // namespace

std::vector<Metaball> cumulusMetaballs(const CumulusParams& params, double density) {
  std::vector<Metaball> balls;
  for (const Ellipsoid& e : cumulusTower(params)) addBubble(e, balls);
  for (Metaball& b : balls) b.centreM.z = std::max(b.centreM.z, (1.0 - kBelow) * b.radiusM);
  // Towards a sum of 1 at every centre: each ball takes its share of what is there (a multiplicative update,
  // so that densities stay positive).
  for (int round = 0; round < kRounds; ++round) {
    const MetaballField field(balls);
    for (Metaball& b : balls) b.density /= std::max(field(b.centreM), 1e-3);
  }
  for (Metaball& b : balls) b.density *= density;
  return balls;
}

}  // namespace welkin::field
