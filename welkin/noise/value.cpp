// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/value.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <vector>

#include "welkin/noise/fill.h"
#include "welkin/noise/value_hash.h"
#include "welkin/noise/value_weights.h"

namespace welkin::noise {
namespace {

CellPlace placeOf(double x) {
  const double cell = std::floor(x);
  return {static_cast<std::int64_t>(cell), x - cell};
}

ValueClock clockOf(const ValueSettings& settings) {
  if (!settings.time) return {};
  const CellPlace& time = *settings.time;
  const Taps taps = tapsOf(settings.interpolation);
  ValueClock clock{taps.count(), kTimePhases, {}, {}};
  for (int t = 0; t <= taps.count(); ++t) {
    const std::uint32_t whole = wrappedCell(time.cell + taps.first - 1 + t, settings.timePeriod);
    clock.first[t] = ownRow(timeSeed(settings.seed, whole), 0, 0).first;
  }
  for (int phase = 0; phase < kTimePhases; ++phase) {
    double inside = time.inside + static_cast<double>(phase) / kTimePhases;
    if (inside >= 1.0) {
      inside -= 1.0;
      clock.later = std::min(clock.later, phase);
    }
    const auto weight = weightsAt(settings.interpolation, inside);
    for (int t = 0; t < taps.count(); ++t) clock.weight[t][phase] = weight[taps.first + t];
  }
  return clock;
}

}  // namespace

Value::Value(const ValueSettings& settings) : settings_(settings), clock_(clockOf(settings)) {
  assert(settings.period.x >= 0 && settings.period.y >= 0 && settings.period.z >= 0);
  assert(!settings.time || (settings.seed != 0 && settings.timePeriod >= 0));
}

float Value::hash(std::int64_t x, std::int64_t y, std::int64_t z) const {
  const glm::ivec3& period = settings_.period;
  const std::uint32_t i = wrappedCell(x, period.x), j = wrappedCell(y, period.y),
                      k = wrappedCell(z, period.z);
  if (settings_.seed == 0) return sourceHash(i + sourceRow(j, k));
  const OwnRow row = ownRow(settings_.seed, j, k);
  if (!settings_.time) return ownHash(ownColumn(i), row);
  const std::uint64_t point = ownPoint(ownColumn(i), row.rest);
  const int phase = timePhase(point), passed = phase >= clock_.later ? 1 : 0;
  double sum = 0.0;
  for (int t = 0; t < clock_.taps; ++t)
    sum += clock_.weight[t][phase] * kOwnStep * ownSteps(clock_.first[passed + t], point);
  return static_cast<float>(sum);
}

float Value::lattice(std::int64_t x, std::int64_t y, std::int64_t z) const {
  if (!settings_.smooth) return hash(x, y, z);
  double cube = 0.0, faces = 0.0;
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const double g = hash(x + i, y + j, z + k);
        cube += g;
        if (std::abs(i) + std::abs(j) + std::abs(k) == 1) faces += g;
      }
  return smoothedValue(cube, faces, hash(x, y, z));
}

ValueAndSlope Value::withSlope(double x, double y, double z) const {
  return withSlope(placeOf(x), placeOf(y), placeOf(z));
}

ValueAndSlope Value::withSlope(CellPlace x, CellPlace y, CellPlace z) const {
  const CellPlace* const places[3] = {&x, &y, &z};
  std::array<double, 4> weight[3], slope[3];
  for (int axis = 0; axis < 3; ++axis) {
    weight[axis] = weightsAt(settings_.interpolation, places[axis]->inside);
    slope[axis] = weightSlopesAt(settings_.interpolation, places[axis]->inside);
  }
  const Taps taps = tapsOf(settings_.interpolation);
  ValueAndSlope sum;
  for (int k = taps.first; k <= taps.last; ++k)
    for (int j = taps.first; j <= taps.last; ++j)
      for (int i = taps.first; i <= taps.last; ++i) {
        const double f = lattice(x.cell + i - 1, y.cell + j - 1, z.cell + k - 1);
        sum.value += f * weight[0][i] * weight[1][j] * weight[2][k];
        sum.slope += f * glm::dvec3(slope[0][i] * weight[1][j] * weight[2][k],
                                    weight[0][i] * slope[1][j] * weight[2][k],
                                    weight[0][i] * weight[1][j] * slope[2][k]);
      }
  return sum;
}

double Value::operator()(double x, double y, double z) const {
  return withSlope(x, y, z).value;
}

void Value::add(std::span<float> out, float weight, const SampleBox& box) const {
  std::array<std::vector<CellPlace>, 3> places;
  for (int axis = 0; axis < 3; ++axis) {
    assert(box.count[axis] >= 1 && box.step[axis] > 0.0);
    for (int i = 0; i < box.count[axis]; ++i) places[axis].push_back(placeOf(box.position(axis, i)));
  }
  add(out, weight, places[0], places[1], places[2]);
}

void Value::add(std::span<float> out, float weight, std::span<const CellPlace> xs,
                std::span<const CellPlace> ys, std::span<const CellPlace> zs) const {
  assert(out.size() == xs.size() * ys.size() * zs.size());
  if (out.empty()) return;
  const ScratchLoan memory, scratch;
  memory->reset();
  std::mutex alone;
  ValueTables octave{};
  setValue(*this, weight, octave);
  const std::span<const CellPlace> places[3] = {xs, ys, zs};
  glm::ivec3 size;
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<int>(places[axis].size());
    octave.axis[axis] = makeValueLine(settings_, axis, places[axis], *memory, alone);
  }
  addValues(octave, size, out.data(), *scratch);
}

double Value::deviation(int dimensions) const {
  // The noise is a sum over lattice points of hashes, each of variance 1/3, times interpolation and
  // smoothing. Its mean square is the sum over distances d of the correlation of the taps' weights, averaged
  // over a cell and multiplied over the axes, times that of the smoothing's.
  constexpr int kSteps = 256;            // averages by the midpoint rule, exact to 1e-5
  std::array<double, 7> within{}, at{};  // by d + 3: inside space, and on a lattice plane
  for (int n = 0; n <= kSteps; ++n) {
    const bool plane = n == kSteps;
    const auto w = weightsAt(settings_.interpolation, plane ? 0.0 : (n + 0.5) / kSteps);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        (plane ? at : within)[a - b + 3] += w[a] * w[b] * (plane ? 1.0 : 1.0 / kSteps);
  }
  const auto stencil = [this](int i, int j, int k) {
    const int away = std::max({std::abs(i), std::abs(j), std::abs(k)});
    if (!settings_.smooth || away > 1) return away == 0 ? 1.0 : 0.0;
    const int steps = std::abs(i) + std::abs(j) + std::abs(k);
    return steps == 0 ? kCentre : steps == 1 ? kFace : kRest;
  };
  double sum = 0.0;
  for (int k = -2; k <= 2; ++k)
    for (int j = -2; j <= 2; ++j)
      for (int i = -2; i <= 2; ++i) {
        double overlap = 0.0;
        for (int c = -1; c <= 1; ++c)
          for (int b = -1; b <= 1; ++b)
            for (int a = -1; a <= 1; ++a) overlap += stencil(a, b, c) * stencil(a + i, b + j, c + k);
        sum += overlap * within[i + 3] * within[j + 3] * (dimensions == 3 ? within : at)[k + 3];
      }
  if (settings_.time) sum *= within[3];  // the phases are all over a cell of time
  return std::sqrt(sum / 3.0);
}

double Value::bound(int dimensions) const {
  // Cubic weights sum to 1.5 in absolute value half way between two points, the others to 1.
  const int axes = dimensions + (settings_.time ? 1 : 0);
  return settings_.interpolation == Interpolation::kCubic ? std::pow(1.5, axes) : 1.0;
}

}  // namespace welkin::noise
