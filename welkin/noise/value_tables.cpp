// SPDX-License-Identifier: Apache-2.0
// What a fill of value noise works out once.
#include <algorithm>
#include <functional>

#include "welkin/core/parallel.h"
#include "welkin/noise/fill.h"
#include "welkin/noise/value_hash.h"
#include "welkin/noise/value_weights.h"

namespace welkin::noise {
namespace {

constexpr std::size_t roundedUp(std::size_t n) {
  return (n + kPad - 1) / kPad * kPad;
}

// Calls each(begin, end, runs) for every sample's points: [begin, end) along the axis, those that its
// smoothing takes among them; `fresh` where they do not follow or overlap those before.
template <class Each>
void forRuns(const ValueSettings& settings, std::span<const CellPlace> places, const Each& each) {
  const Taps taps = tapsOf(settings.interpolation);
  const int margin = settings.smooth ? 1 : 0;
  std::int64_t runBegin = 0, runEnd = 0;
  bool fresh = true;
  for (const CellPlace& place : places) {
    const std::int64_t tap = place.cell + taps.first - 1;
    const std::int64_t begin = tap - margin, end = tap + taps.count() + margin;
    if (fresh || begin < runBegin || begin > runEnd) runBegin = runEnd = begin;
    fresh = false;
    each(tap, runEnd, end);
    runEnd = std::max(runEnd, end);
  }
}

}  // namespace

ValueLine makeValueLine(const ValueSettings& settings, int axis, std::span<const CellPlace> places,
                        Scratch& memory, std::mutex& taking) {
  const Taps taps = tapsOf(settings.interpolation);
  std::size_t points = 0;
  forRuns(settings, places, [&](std::int64_t, std::int64_t from, std::int64_t to) {
    points += static_cast<std::size_t>(std::max<std::int64_t>(to - from, 0));
  });
  const std::size_t samples = places.size(), length = roundedUp(samples), room = roundedUp(points) + kPad;
  std::int32_t* first;
  std::array<float*, 4> weight{};
  std::uint32_t* index;
  std::uint64_t* column;
  {
    const std::lock_guard lock(taking);
    first = memory.take<std::int32_t>(length);
    for (int t = 0; t < taps.count(); ++t) weight[t] = memory.take<float>(length);
    index = memory.take<std::uint32_t>(room);
    column = memory.take<std::uint64_t>(room);
  }
  std::size_t i = 0;
  std::int32_t listed = 0;
  forRuns(settings, places, [&](std::int64_t tap, std::int64_t from, std::int64_t to) {
    for (; from < to; ++from) index[listed++] = wrappedCell(from, settings.period[axis]);
    first[i] = listed - static_cast<std::int32_t>(from - tap);
    const auto w = weightsAt(settings.interpolation, places[i].inside);
    for (int t = 0; t < taps.count(); ++t) weight[t][i] = static_cast<float>(w[taps.first + t]);
    ++i;
  });
  std::fill(first + samples, first + length, first[samples - 1]);
  for (int t = 0; t < taps.count(); ++t) std::fill(weight[t] + samples, weight[t] + length, 0.0f);
  std::fill(index + points, index + room, 0u);
  for (std::size_t p = 0; p < room; ++p) column[p] = ownColumn(index[p]);
  return {first, {weight[0], weight[1], weight[2], weight[3]}, listed, index, column};
}

void setValue(const Value& noise, float weight, ValueTables& out) {
  const ValueClock& clock = noise.clock();
  out.settings = noise.settings();
  out.taps = tapsOf(out.settings.interpolation).count();
  out.weight = weight;
  out.clock = clock.taps > 0 ? &clock : nullptr;
  for (int t = 0; t < 4; ++t)
    for (int phase = 0; phase < kTimePhases; ++phase)
      out.timeWeight[t][phase] = static_cast<float>(clock.weight[t][phase]) * kOwnStep;
}

void makeValueTables(FillJob& job, Scratch& memory) {
  const std::vector<ValueTerm>& terms = job.plan->values;
  const int dimensions = static_cast<int>(job.params->dimensions);
  job.valueTerms = static_cast<int>(terms.size());
  job.values = memory.take<ValueTables>(terms.size());
  std::mutex taking;
  const auto body = [&](std::size_t begin, std::size_t end) {
    const ScratchLoan scratch;
    scratch->reset();
    const int most = std::max({job.box.size.x, job.box.size.y, job.box.size.z});
    const std::span places(scratch->take<CellPlace>(static_cast<std::size_t>(most)),
                           static_cast<std::size_t>(most));
    for (std::size_t t = begin; t < end; ++t) {
      const ValueTerm& term = terms[t];
      ValueTables& out = job.values[t];
      const bool folded = job.params->fractal == Fractal::kFbm;
      setValue(term.noise, folded ? static_cast<float>(term.weight) : 1.0f, out);
      for (int axis = 0; axis < 3; ++axis) {
        const auto count = static_cast<std::size_t>(job.box.size[axis]);
        for (std::size_t i = 0; i < count; ++i) {
          if (axis >= dimensions) {
            places[i] = term.beyond;
            continue;
          }
          const Span span =
              term.axes[axis].at((job.box.first[axis] + static_cast<int>(i) + 0.5) * job.grid.spacing[axis]);
          places[i] = {span.low, span.inside};
        }
        out.axis[axis] = makeValueLine(out.settings, axis, places.first(count), memory, taking);
      }
    }
  };
  parallelFor(terms.size(), 1, std::ref(body));
}

}  // namespace welkin::noise
