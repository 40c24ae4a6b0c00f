// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace welkin::app {

// Wall clock since it was made.
class Stopwatch {
 public:
  double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace welkin::app
