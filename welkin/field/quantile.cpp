// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/quantile.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "welkin/core/ordered_key.h"

namespace welkin::field {
namespace {

constexpr std::uint32_t kBins = 65536;

// The bin that holds the sample of this rank (from 0, rising), and how many samples are in bins beneath it.
struct Place {
  std::uint32_t bin;
  std::uint64_t beneath;
};
Place placeOf(const std::vector<std::uint64_t>& counts, std::uint64_t rank, std::uint64_t beneath = 0) {
  std::uint32_t bin = 0;
  while (bin + 1 < kBins && beneath + counts[bin] <= rank) beneath += counts[bin++];
  return {bin, beneath};
}

void mergeCounts(std::vector<std::uint64_t>& to, std::vector<std::uint64_t>& from) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += std::exchange(from[i], 0);
}

}  // namespace

SampleQuantile::SampleQuantile(double fraction) : fraction_(fraction), upper_(kBins) {
  assert(fraction >= 0.0 && fraction <= 1.0);
}

void SampleQuantile::add(std::span<const float> samples) {
  if (!secondPass_) {
    for (const float x : samples) ++upper_[orderedKey(x) >> 16];
    count_ += samples.size();
    return;
  }
  for (const float x : samples) {
    const std::uint32_t key = orderedKey(x), bin = key >> 16;
    if (bin == lowBin_) ++low_[key & 0xffff];
    if (bin == highBin_) ++high_[key & 0xffff];
  }
}

void SampleQuantile::merge(SampleQuantile& other) {
  assert(secondPass_ == other.secondPass_);
  if (secondPass_) {
    mergeCounts(low_, other.low_);
    mergeCounts(high_, other.high_);
  } else {
    mergeCounts(upper_, other.upper_);
    count_ += std::exchange(other.count_, 0);
  }
}

void SampleQuantile::nextPass() {
  assert(!secondPass_ && count_ > 0);
  secondPass_ = true;
  above_ = static_cast<std::uint64_t>(std::llround(fraction_ * static_cast<double>(count_)));
  // The samples just below and just above the threshold; at either end there is but one.
  const std::uint64_t rank = count_ - above_;
  const Place low = placeOf(upper_, rank > 0 ? rank - 1 : 0);
  const Place high = placeOf(upper_, rank < count_ ? rank : count_ - 1);
  lowBin_ = low.bin, belowLow_ = low.beneath;
  highBin_ = high.bin, belowHigh_ = high.beneath;
  low_.assign(kBins, 0);
  high_.assign(kBins, 0);
}

double SampleQuantile::threshold() const {
  assert(secondPass_);
  const std::uint64_t rank = count_ - above_;
  const Place low = placeOf(low_, rank > 0 ? rank - 1 : 0, belowLow_);
  const Place high = placeOf(high_, rank < count_ ? rank : count_ - 1, belowHigh_);
  const float a = floatOfKey(lowBin_ << 16 | low.bin), b = floatOfKey(highBin_ << 16 | high.bin);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (rank == count_) return a;
  if (rank == 0) return std::nextafter(b, -kInfinity);
  if (a < b) {
    const float middle = static_cast<float>(0.5 * (static_cast<double>(a) + static_cast<double>(b)));
    return middle < b ? middle : a;
  }
  // Equal ones on both sides go where that is nearer to what is wanted.
  const std::uint64_t with = count_ - low.beneath, without = with - low_[low.bin];
  return above_ - without <= with - above_ ? a : std::nextafter(a, -kInfinity);
}

double quantileAbove(std::span<const float> samples, double fraction) {
  SampleQuantile quantile(fraction);
  quantile.add(samples);
  quantile.nextPass();
  quantile.add(samples);
  return quantile.threshold();
}

}  // namespace welkin::field
