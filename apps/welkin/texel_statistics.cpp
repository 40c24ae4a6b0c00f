// SPDX-License-Identifier: Apache-2.0
#include "texel_statistics.h"

#include <algorithm>
#include <cmath>

namespace welkin::app {

double visibleIn(io::ValueType type) {
  switch (type) {
    case io::ValueType::kUnorm8:
      return 0.5 / 255.0;
    case io::ValueType::kUnorm16:
      return 0.5 / 65535.0;
    case io::ValueType::kHalf:
      return std::exp2(-25.0);  // half of the smallest half
    case io::ValueType::kFloat:
      break;
  }
  return 0.0;
}

void TexelStatistics::add(std::span<const float> values) {
  if (values.empty()) return;
  if (count_ == 0) least_ = greatest_ = values.front();
  // Bins are counted in fours, since neighbouring values often fall into the same one.
  std::array<std::array<std::uint64_t, kBins>, 4> counts{};
  const auto visible = static_cast<float>(visible_);
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float v = values[i];
    least_ = std::min(least_, v);
    greatest_ = std::max(greatest_, v);
    sum += v;
    squares += static_cast<double>(v) * v;
    covered_ += visible > 0.0f ? v >= visible : v > 0.0f;
    ++counts[i & 3][static_cast<std::size_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f)];
  }
  for (const auto& part : counts)
    for (int i = 0; i < kBins; ++i) histogram_[i] += part[i];
  count_ += values.size();
  sum_ += sum;
  squares_ += squares;
}

double TexelStatistics::deviation() const {
  const double m = mean();
  return std::sqrt(std::max(squares_ / static_cast<double>(count_) - m * m, 0.0));
}

}  // namespace welkin::app
