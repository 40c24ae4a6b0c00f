// SPDX-License-Identifier: Apache-2.0
// How often the values of a pattern of noise occur, as a small table: for what asks again and again, at every
// instant, how much of it lies above a threshold.
#pragma once

#include <array>
#include <span>

namespace welkin::field {

class PatternQuantiles {
 public:
  static constexpr int kSteps = 256;

  PatternQuantiles() = default;  // of a pattern that is nought everywhere
  // Values in [0, 1], at least one; counted in 65536 classes.
  explicit PatternQuantiles(std::span<const float> pattern);

  // The value that this fraction of the pattern exceeds: falls from the greatest at 0 to the least at 1,
  // linear between steps.
  double above(double fraction) const;

 private:
  std::array<float, kSteps + 1> values_{};  // by the fraction above, in steps
};

}  // namespace welkin::field
