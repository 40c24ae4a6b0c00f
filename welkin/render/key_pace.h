// SPDX-License-Identifier: Apache-2.0
// When to make what is known at key instants, whole multiples of an interval, and blended in between: while
// time runs through one interval, forwards or backwards, the key after it is made a portion at a time.
#pragma once

#include <algorithm>
#include <cmath>

namespace welkin::render {

class KeyPace {
 public:
  // At an instant; of every frame.
  void moveTo(double seconds, double interval) {
    const double before = std::floor(seconds / interval) * interval;
    const bool forward = seconds >= lastS_;
    const double passed = (seconds - before) / interval;
    share_ = forward ? passed : 1.0 - passed;
    next_ = forward ? before + 2.0 * interval : before - interval;
    lastS_ = seconds;
  }
  double next() const { return next_; }    // the key instant that comes after those of the interval
  double share() const { return share_; }  // of the interval that has passed

  // The share of a key that should be done, all of it a little before it is asked for, where it was started
  // at a share of the interval.
  double due(double startedAt) const {
    constexpr double kReady = 0.9;
    const double ready = std::max(kReady, 0.5 * (1.0 + startedAt));
    return std::min((share_ - startedAt) / (ready - startedAt), 1.0);
  }

 private:
  double lastS_ = 0.0, next_ = 0.0, share_ = 0.0;
};

}  // namespace welkin::render
