// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/value_sum.h"

#include <algorithm>
#include <array>

#include "welkin/core/parallel.h"

namespace welkin::noise {
namespace {

using Places = std::array<std::vector<CellPlace>, 3>;

// In a plane z is a lattice point.
CellPlace placeOn(const ValueTerm& term, const NoiseParams& params, int axis, double p) {
  if (axis >= params.dimensions) return {};
  const Span span = term.axes[axis].at(p);
  return {span.low, span.inside};
}

// Where samples [begin, begin + count) of a grid's axis lie on an octave.
void setPlaces(const ValueTerm& term, const NoiseParams& params, const Grid& grid, int axis, int begin,
               int count, std::vector<CellPlace>& places) {
  places.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    places[i] = placeOn(term, params, axis, (begin + i + 0.5) * grid.spacing[axis]);
}

// Memory of one thread that is kept for the next fill.
struct Room {
  std::vector<Places> places;
  std::vector<float> sum, octave;
};

// Adds shaped octaves: `octave` is memory as large as `sum`.
void addTerms(const std::vector<ValueTerm>& terms, Fractal fractal, std::span<const Places> places,
              std::span<float> sum, std::span<float> octave) {
  std::fill(sum.begin(), sum.end(), 0.0f);
  for (std::size_t o = 0; o < terms.size(); ++o) {
    const auto& [x, y, z] = places[o];
    const auto weight = static_cast<float>(terms[o].weight);
    if (fractal == Fractal::kFbm) {
      terms[o].noise.add(sum, weight, x, y, z);
      continue;
    }
    std::fill(octave.begin(), octave.end(), 0.0f);
    terms[o].noise.add(octave, 1.0f, x, y, z);
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += weight * static_cast<float>(shaped(fractal, octave[i]));
  }
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

void fillValues(const Plan& plan, const NoiseParams& params, const Grid& grid, const Box& box,
                const std::function<void(std::size_t at, std::span<const float> row)>& store) {
  // Blocks of rows and slices, so that neighbours share the lattice between them; whole rows.
  const glm::ivec3 block(box.size.x, params.dimensions == 3 ? 32 : 64, params.dimensions == 3 ? 16 : 1);
  const int down = (box.size.y + block.y - 1) / block.y, deep = (box.size.z + block.z - 1) / block.z;
  const auto body = [&](std::size_t begin, std::size_t end) {
    thread_local Room room;
    auto& [places, sum, octave] = room;
    if (places.size() < plan.values.size()) places.resize(plan.values.size());
    for (std::size_t b = begin; b < end; ++b) {
      const int y0 = static_cast<int>(b % down) * block.y, z0 = static_cast<int>(b / down) * block.z;
      const glm::ivec3 size(box.size.x, std::min(block.y, box.size.y - y0),
                            std::min(block.z, box.size.z - z0));
      const glm::ivec3 first = box.first + glm::ivec3(0, y0, z0);
      for (std::size_t o = 0; o < plan.values.size(); ++o)
        for (int axis = 0; axis < 3; ++axis)
          setPlaces(plan.values[o], params, grid, axis, first[axis], size[axis], places[o][axis]);
      sum.resize(static_cast<std::size_t>(size.x) * size.y * size.z);
      octave.resize(params.fractal == Fractal::kFbm ? 0 : sum.size());
      addTerms(plan.values, params.fractal, places, sum, octave);
      for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
          store((static_cast<std::size_t>(z0 + z) * box.size.y + y0 + y) * size.x,
                std::span(sum).subspan((static_cast<std::size_t>(z) * size.y + y) * size.x, size.x));
    }
  };
  parallelFor(static_cast<std::size_t>(down) * deep, 1, std::ref(body));
}

}  // namespace welkin::noise
