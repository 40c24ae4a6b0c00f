// SPDX-License-Identifier: Apache-2.0
// What tables of phase functions, at angles evenly from 0 to 180 degrees, come to over the sphere.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "welkin/core/image.h"
#include "welkin/core/units.h"

namespace welkin::optics {

struct PhaseIntegral {
  double whole = 0.0, forward = 0.0;  // of the phase function; of it times the cosine
};

// None of the channel's values may be 0 or less.
inline PhaseIntegral integralOf(const Image<float>& phase, int channel) {
  PhaseIntegral sum;
  const double step = kPi / (phase.width - 1);
  for (int i = 0; i + 1 < phase.width; ++i) {
    EXPECT_GT(phase.at(i, 0, channel), 0.0f);
    const double middle = (i + 0.5) * step;
    const double p = 0.5 * static_cast<double>(phase.at(i, 0, channel) + phase.at(i + 1, 0, channel));
    const double share = 2.0 * kPi * p * std::sin(middle) * step;
    sum.whole += share;
    sum.forward += share * std::cos(middle);
  }
  return sum;
}

}  // namespace welkin::optics
