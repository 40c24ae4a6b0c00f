// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/pattern_quantiles.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace welkin::field {

PatternQuantiles::PatternQuantiles(std::span<const float> pattern) {
  constexpr int kClasses = 65536;
  std::vector<std::uint32_t> counts(kClasses, 0);
  const auto [least, greatest] = std::minmax_element(pattern.begin(), pattern.end());
  for (const float p : pattern)
    ++counts[static_cast<std::size_t>(std::clamp(p, 0.0f, 1.0f) * static_cast<float>(kClasses - 1))];
  const auto total = static_cast<double>(pattern.size());
  values_.front() = *greatest;
  values_.back() = *least;
  double counted = 0.0;
  int step = 1;
  for (int c = kClasses - 1; c >= 0 && step < kSteps; --c) {
    counted += counts[static_cast<std::size_t>(c)];
    for (; step < kSteps && counted >= total * step / kSteps; ++step)
      values_[static_cast<std::size_t>(step)] =
          std::clamp((static_cast<float>(c) + 0.5f) / static_cast<float>(kClasses - 1), *least, *greatest);
  }
}

double PatternQuantiles::above(double fraction) const {
  const double x = std::clamp(fraction, 0.0, 1.0) * kSteps;
  const auto i = static_cast<std::size_t>(std::min(x, kSteps - 1.0));
  return values_[i] + (x - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
}

}  // namespace welkin::field
