// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/value_sum.h"

namespace welkin::noise {
namespace {

CellPlace placeOn(const ValueTerm& term, const NoiseParams& params, int axis, double p) {
  if (axis >= params.dimensions) return term.beyond;
  const Span span = term.axes[axis].at(p);
  return {span.low, span.inside};
}

}  // namespace

double valueSum(const std::vector<ValueTerm>& terms, const NoiseParams& params, const glm::dvec3& p) {
  double sum = 0.0;
  for (const ValueTerm& t : terms)
    sum += t.weight *
           shaped(params.fractal, t.noise
                                      .withSlope(placeOn(t, params, 0, p.x), placeOn(t, params, 1, p.y),
                                                 placeOn(t, params, 2, p.z))
                                      .value);
  return sum;
}

ValueAndSlope valueSlope(const std::vector<ValueTerm>& terms, const NoiseParams& params,
                         const glm::dvec3& p) {
  ValueAndSlope sum;
  for (const ValueTerm& t : terms) {
    const ValueAndSlope n =
        t.noise.withSlope(placeOn(t, params, 0, p.x), placeOn(t, params, 1, p.y), placeOn(t, params, 2, p.z));
    sum.value += t.weight * n.value;
    for (int axis = 0; axis < params.dimensions; ++axis)
      sum.slope[axis] += t.weight * n.slope[axis] * t.axes[axis].frequency();
  }
  return sum;
}

}  // namespace welkin::noise
