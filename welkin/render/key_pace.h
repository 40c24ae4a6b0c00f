// SPDX-License-Identifier: Apache-2.0
// When to make what is known at key instants, whole multiples of an interval, and blended in between: while
// time runs through one interval, forwards or backwards, the key after it is made a portion at a time. Key
// heights are the same to an eye that climbs or sinks.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace welkin::render {

class KeyPace {
 public:
  // At an instant, or wherever else keys lie; of every frame.
  void moveTo(double at, double interval) {
    const double before = std::floor(at / interval) * interval;
    const bool forward = !(at < last_);
    const double passed = (at - before) / interval;
    share_ = forward ? passed : 1.0 - passed;
    last_ = at;
    const double next = forward ? before + 2.0 * interval : before - interval;
    if (next == next_) return;
    next_ = next;
    startedAt_ = share_;
  }
  double next() const { return next_; }  // the key that comes after those of the interval

  // The share of it that should be done, all of it a little before it is asked for. None at first.
  double due() const {
    constexpr double kReady = 0.9;
    const double ready = std::max(kReady, 0.5 * (1.0 + startedAt_));
    return std::clamp((share_ - startedAt_) / (ready - startedAt_), 0.0, 1.0);
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double last_ = kNone, next_ = kNone;
  double share_ = 0.0, startedAt_ = 0.0;  // of the interval: that has passed, that had when next_ came to be
};

}  // namespace welkin::render
