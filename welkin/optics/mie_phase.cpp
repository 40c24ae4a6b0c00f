// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/mie_phase.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "welkin/core/units.h"
#include "welkin/optics/mie_table.h"

namespace welkin::optics {
namespace {

static_assert(detail::kMieDiametersUm.back() == kLargestMieDropletUm);

// The column at or below x of those that are interpolated between, and how far x is towards the next.
struct Between {
  std::size_t first = 0;
  double share = 0.0;
};

Between diameterAt(double d) {
  const auto& all = detail::kMieDiametersUm;
  d = std::clamp(d, all.front(), all.back());
  const auto next = std::upper_bound(all.begin() + 1, all.end() - 1, d);
  const double low = *(next - 1), high = *next;
  return {static_cast<std::size_t>(next - all.begin()) - 1, std::log(d / low) / std::log(high / low)};
}

}  // namespace

double phaseMieDroplet(double c, double diameterUm) {
  const double deg = std::acos(std::clamp(c, -1.0, 1.0)) * 180.0 / kPi;
  const Between d = diameterAt(diameterUm);
  const auto logPhase = [&d](const detail::MieRow& row) {
    return (1.0 - d.share) * std::log(row.phase[d.first]) + d.share * std::log(row.phase[d.first + 1]);
  };
  const auto next =
      std::upper_bound(std::begin(detail::kMieRows) + 1, std::end(detail::kMieRows) - 1, deg,
                       [](double angle, const detail::MieRow& row) { return angle < row.angleDeg; });
  const detail::MieRow &low = *(next - 1), &high = *next;
  const double t = std::clamp((deg - low.angleDeg) / (high.angleDeg - low.angleDeg), 0.0, 1.0);
  return std::exp((1.0 - t) * logPhase(low) + t * logPhase(high));
}

}  // namespace welkin::optics
