// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/value.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "welkin/core/random.h"
#include "welkin/noise/value_rows.h"

namespace welkin::noise {
namespace {

// What each lattice point near a position weighs on one axis: points from -1 to 2 beside the cell's lower
// one.
struct Weights {
  std::array<double, 4> value{}, slope{};
};

Weights weightsAt(Interpolation interpolation, double x) {
  switch (interpolation) {
    case Interpolation::kLinear:
      return {{0.0, 1.0 - x, x, 0.0}, {0.0, -1.0, 1.0, 0.0}};
    case Interpolation::kCosine: {
      const double f = 0.5 * (1.0 - std::cos(std::numbers::pi * x));
      const double slope = 0.5 * std::numbers::pi * std::sin(std::numbers::pi * x);
      return {{0.0, 1.0 - f, f, 0.0}, {0.0, -slope, slope, 0.0}};
    }
    case Interpolation::kCubic:
      break;
  }
  // P x^3 + Q x^2 + R x + S with P = (v3 - v2) - (v0 - v1), Q = v0 - v1 - P, R = v2 - v0, S = v1, sorted by
  // v.
  const double x2 = x * x, x3 = x2 * x;
  return {{-x3 + 2 * x2 - x, x3 - 2 * x2 + 1, -x3 + x2 + x, x3 - x2},
          {-3 * x2 + 4 * x - 1, 3 * x2 - 4 * x, -3 * x2 + 2 * x + 1, 3 * x2 - 2 * x}};
}

CellPlace placeOf(double x) {
  const double cell = std::floor(x);
  return {static_cast<std::int64_t>(cell), x - cell};
}

struct Taps {
  int first, last;
};
Taps tapsOf(Interpolation interpolation) {
  return interpolation == Interpolation::kCubic ? Taps{0, 3} : Taps{1, 2};
}

// out += the row between its points: of the points from first[i] on, each weighs weight[tap][i]. Number by
// number: the processor's own gathering of so many is slower.
template <int kTaps>
void addSamples(const float* row, const std::int32_t* first, const std::array<std::vector<float>, 4>& weight,
                std::span<float> out) {
  std::array<const float*, kTaps> w;
  for (int t = 0; t < kTaps; ++t) w[t] = weight[t].data();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* from = row + first[i];
    float sum = w[0][i] * from[0];
    for (int t = 1; t < kTaps; ++t) sum += w[t][i] * from[t];
    out[i] += sum;
  }
}

}  // namespace

Value::Value(const ValueSettings& settings) : settings_(settings) {
  assert(settings.period.x >= 0 && settings.period.y >= 0 && settings.period.z >= 0);
}

std::uint32_t Value::wrapped(std::int64_t i, int axis) const {
  const std::int64_t period = settings_.period[axis];
  if (period == 0) return static_cast<std::uint32_t>(i);
  const std::int64_t r = i % period;
  return static_cast<std::uint32_t>(r < 0 ? r + period : r);
}

float Value::hash(std::int64_t x, std::int64_t y, std::int64_t z) const {
  const std::uint32_t i = wrapped(x, 0), j = wrapped(y, 1), k = wrapped(z, 2);
  if (settings_.seed == 0) return sourceHash(i + sourceRow(j, k));
  return ownHash(hashOf(i), ownRow(settings_.seed, j, k));
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
  const Weights wx = weightsAt(settings_.interpolation, x.inside),
                wy = weightsAt(settings_.interpolation, y.inside),
                wz = weightsAt(settings_.interpolation, z.inside);
  const Taps taps = tapsOf(settings_.interpolation);
  ValueAndSlope sum;
  for (int k = taps.first; k <= taps.last; ++k)
    for (int j = taps.first; j <= taps.last; ++j)
      for (int i = taps.first; i <= taps.last; ++i) {
        const double f = lattice(x.cell + i - 1, y.cell + j - 1, z.cell + k - 1);
        sum.value += f * wx.value[i] * wy.value[j] * wz.value[k];
        sum.slope +=
            f * glm::dvec3(wx.slope[i] * wy.value[j] * wz.value[k], wx.value[i] * wy.slope[j] * wz.value[k],
                           wx.value[i] * wy.value[j] * wz.slope[k]);
      }
  return sum;
}

double Value::operator()(double x, double y, double z) const {
  return withSlope(x, y, z).value;
}

// Where the samples of one axis fall among the lattice points that they need.
struct Value::Axis {
  std::vector<std::uint32_t> points;         // indices of lattice points, the smoothing's margin among them
  std::vector<std::uint64_t> hashed;         // the same, hashed
  std::vector<std::int32_t> first;           // for each sample, where in `points` its first tap is
  std::array<std::vector<float>, 4> weight;  // by tap, for each sample
  int taps = 0;

  void set(const Value& noise, int axis, std::span<const CellPlace> places) {
    const ValueSettings& settings = noise.settings_;
    points.clear();
    first.clear();
    for (auto& w : weight) w.clear();
    const Taps range = tapsOf(settings.interpolation);
    taps = range.last - range.first + 1;
    const int margin = settings.smooth ? 1 : 0;
    std::int64_t runBegin = 0, runEnd = 0;  // the points that end the list, without a gap
    for (const CellPlace& place : places) {
      const std::int64_t tap = place.cell + range.first - 1;
      const std::int64_t begin = tap - margin, end = tap + taps + margin;
      if (points.empty() || begin < runBegin || begin > runEnd) runBegin = runEnd = begin;
      for (; runEnd < end; ++runEnd) points.push_back(noise.wrapped(runEnd, axis));
      first.push_back(size() - static_cast<int>(runEnd - tap));
      const Weights w = weightsAt(settings.interpolation, place.inside);
      for (int t = 0; t < taps; ++t) weight[t].push_back(static_cast<float>(w.value[range.first + t]));
    }
    hashed.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) hashed[i] = hashOf(points[i]);
  }
  int size() const { return static_cast<int>(points.size()); }
};

// The lattice under a box, plane by plane; those in use are kept.
class Value::Planes {
 public:
  void begin(const Value& noise, const Axis& x, const Axis& y, const Axis& z) {
    noise_ = &noise;
    x_ = &x;
    y_ = &y;
    z_ = &z;
    for (auto* planes : {&smooth_, &hashed_})
      for (Plane& plane : *planes) plane.k = -1;
  }

  // Plane `k` of z.points; asked for in rising order, up to a step back of `taps`.
  const std::vector<float>& at(int k) {
    if (!noise_->settings_.smooth) return hashed(k).values;
    Plane& plane = smooth_[k % smooth_.size()];
    if (plane.k != k) {
      plane.k = k;
      smooth(plane.values, hashed(k - 1), hashed(k), hashed(k + 1));
    }
    return plane.values;
  }

 private:
  struct Plane {
    int k = -1;
    std::vector<float> values;  // x fastest, of x.points and y.points
    std::vector<double> boxes;  // of hashes that are to be smoothed: sums over 3 x 3 of them
  };

  const Plane& hashed(int k) {
    Plane& plane = hashed_[k % hashed_.size()];
    if (plane.k == k) return plane;
    plane.k = k;
    const int width = x_->size(), rows = y_->size();
    plane.values.resize(static_cast<std::size_t>(width) * rows);
    const std::uint64_t seed = noise_->settings_.seed;
    for (int y = 0; y < rows; ++y) {
      float* out = &plane.values[static_cast<std::size_t>(y) * width];
      if (seed == 0)
        sourceHashes(x_->points.data(), width, sourceRow(y_->points[y], z_->points[k]), out);
      else
        ownHashes(x_->hashed.data(), width, ownRow(seed, y_->points[y], z_->points[k]), out);
    }
    if (!noise_->settings_.smooth) return plane;
    plane.boxes.resize(plane.values.size());
    for (int y = 1; y + 1 < rows; ++y)
      sumBoxes(&plane.values[static_cast<std::size_t>(y) * width], width,
               &plane.boxes[static_cast<std::size_t>(y) * width]);
    return plane;
  }

  // The margin of `out`, whose neighbours are missing, is left as it is: no sample has a tap there.
  void smooth(std::vector<float>& out, const Plane& below, const Plane& here, const Plane& above) const {
    const int width = x_->size();
    out.resize(here.values.size());
    for (int y = 1; y + 1 < y_->size(); ++y) {
      const std::size_t at = static_cast<std::size_t>(y) * width;
      smoothRow({&below.values[at], &here.values[at], &above.values[at]},
                {&below.boxes[at], &here.boxes[at], &above.boxes[at]}, width, &out[at]);
    }
  }

  const Value* noise_ = nullptr;
  const Axis *x_ = nullptr, *y_ = nullptr, *z_ = nullptr;
  std::array<Plane, 4> smooth_, hashed_;
};

// Memory of one thread that is kept for the next box.
struct Value::Room {
  Axis x, y, z;
  Planes planes;
  std::vector<float> slice, row;
};

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
  thread_local Room room;
  auto& [x, y, z, planes, slice, row] = room;
  x.set(*this, 0, xs);
  y.set(*this, 1, ys);
  z.set(*this, 2, zs);
  planes.begin(*this, x, y, z);
  slice.resize(static_cast<std::size_t>(x.size()) * y.size());
  row.resize(x.points.size());
  std::size_t n = 0;
  for (std::size_t k = 0; k < zs.size(); ++k) {
    std::array<Tap, 4> taps;
    int count = 0;
    for (int t = 0; t < z.taps; ++t)  // in a plane all but one weigh nothing
      if (z.weight[t][k] != 0.0f) taps[count++] = {planes.at(z.first[k] + t).data(), weight * z.weight[t][k]};
    mixRows(std::span(taps).first(count), static_cast<int>(slice.size()), slice.data());
    for (std::size_t j = 0; j < ys.size(); ++j, n += xs.size()) {
      for (int t = 0; t < y.taps; ++t)
        taps[t] = {&slice[static_cast<std::size_t>(y.first[j] + t) * row.size()], y.weight[t][j]};
      mixRows(std::span(taps).first(y.taps), x.size(), row.data());
      if (x.taps == 2)
        addSamples<2>(row.data(), x.first.data(), x.weight, out.subspan(n, xs.size()));
      else
        addSamples<4>(row.data(), x.first.data(), x.weight, out.subspan(n, xs.size()));
    }
  }
}

double Value::deviation(int dimensions) const {
  // The noise is a sum over lattice points of hashes, each of variance 1/3, times interpolation and
  // smoothing. Its mean square is the sum over distances d of the correlation of the taps' weights, averaged
  // over a cell and multiplied over the axes, times that of the smoothing's.
  constexpr int kSteps = 256;            // averages by the midpoint rule, exact to 1e-5
  std::array<double, 7> within{}, at{};  // by d + 3: inside space, and on a lattice plane
  for (int n = 0; n <= kSteps; ++n) {
    const bool plane = n == kSteps;
    const Weights w = weightsAt(settings_.interpolation, plane ? 0.0 : (n + 0.5) / kSteps);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        (plane ? at : within)[a - b + 3] += w.value[a] * w.value[b] * (plane ? 1.0 : 1.0 / kSteps);
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
  return std::sqrt(sum / 3.0);
}

double Value::bound(int dimensions) const {
  // Cubic weights sum to 1.5 in absolute value half way between two points, the others to 1.
  return settings_.interpolation == Interpolation::kCubic ? std::pow(1.5, dimensions) : 1.0;
}

}  // namespace welkin::noise
