// SPDX-License-Identifier: Apache-2.0
// What the values of a texture are like.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "welkin/io/texels.h"

namespace welkin::app {

// Least opacity or density that is not 0 once stored in that type; 0 if any is.
double visibleIn(io::ValueType type);

class TexelStatistics {
 public:
  static constexpr int kBins = 256;  // bin i: what an 8-bit texel stores as i
  explicit TexelStatistics(io::ValueType type) : visible_(visibleIn(type)) {}

  void add(std::span<const float> values);  // in [0, 1]; what is outside counts into the outermost bins

  double mean() const { return sum_ / static_cast<double>(count_); }
  double deviation() const;
  float least() const { return least_; }
  float greatest() const { return greatest_; }
  double covered() const {
    return static_cast<double>(covered_) / static_cast<double>(count_);
  }  // not stored as 0
  std::uint64_t count() const { return count_; }
  const std::array<std::uint64_t, kBins>& histogram() const { return histogram_; }

 private:
  double visible_;
  std::array<std::uint64_t, kBins> histogram_{};
  std::uint64_t count_ = 0, covered_ = 0;
  double sum_ = 0.0, squares_ = 0.0;
  float least_ = 0.0f, greatest_ = 0.0f;
};

}  // namespace welkin::app
