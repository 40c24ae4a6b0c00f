// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/lattice.h"

#include <cmath>

namespace welkin::noise {
namespace {

// p reduced to [0, repeat), exactly.
double wrapTo(double p, double repeat) {
  const double r = std::fmod(p, repeat);
  return r < 0.0 ? r + repeat : r;
}

}  // namespace

Axis::Axis(std::uint32_t key, double frequency, double offset, double repeat, double cells)
    : key_(key),
      period_(static_cast<std::uint32_t>(std::lround(repeat * frequency))),
      frequency_(frequency),
      offset_(repeat > 0.0 ? wrapTo(offset, repeat) : offset),
      repeat_(repeat),
      cells_(cells) {}

Span Axis::at(double p, double shiftCells) const {
  if (repeat_ > 0.0) p = wrapTo(p, repeat_);
  // The sum and the product with what rounding takes from them (D. Knuth 1969, "two-sum"; T. Dekker 1971).
  const double sum = p + offset_;
  const double back = sum - p;
  const double sumError = (p - (sum - back)) + (offset_ - back);
  const double product = sum * frequency_;
  if (!std::isfinite(product)) return at(0.0, shiftCells);
  const double error = std::fma(sum, frequency_, -product) + sumError * frequency_;
  const double cell = std::floor(product);
  double inside = ((product - cell) + error) + (cells_ + shiftCells);
  const double period = period_ == 0 ? 4294967296.0 : static_cast<double>(period_);
  auto low = static_cast<std::uint32_t>(cell - period * std::floor(cell / period));
  if (inside < 0.0 || inside >= 1.0) {
    double step = std::floor(inside);
    inside -= step;
    if (inside >= 1.0) {  // a negative number too small to be taken from one
      step += 1.0;
      inside = 0.0;
    }
    // Far away a double holds no single cells, and a step has many.
    low = moved(low, static_cast<std::int64_t>(std::fmod(step, period)));
  }
  return {low, moved(low, 1), inside};
}

std::uint32_t Axis::moved(std::uint32_t index, std::int64_t steps) const {
  if (period_ == 0) return index + static_cast<std::uint32_t>(steps);
  std::int64_t i = index + steps;
  if (i < 0 || i >= period_) i %= period_;  // divisions are slow
  return static_cast<std::uint32_t>(i < 0 ? i + period_ : i);
}

}  // namespace welkin::noise
