// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/ice_phase.h"

#include <cmath>

#include "welkin/core/units.h"
#include "welkin/optics/ice_table.h"
#include "welkin/optics/phase.h"

namespace welkin::optics {

Image<float> icePhase() {
  Image<float> phase(kIceAngles, 1, 4);
  fillColours(detail::kIceRows, phase);
  const IcePeak peak = icePeak();
  for (int i = 0; i < kIceAngles; ++i) {
    const double angle = kPi * i / (kIceAngles - 1);
    const float narrow = peak.share * phaseHenyeyGreenstein(static_cast<float>(std::cos(angle)), peak.g);
    float sum = 0.0f;
    for (int c = 0; c < 3; ++c) {
      phase.at(i, 0, c) = narrow + (1.0f - peak.share) * phase.at(i, 0, c);
      sum += phase.at(i, 0, c);
    }
    phase.at(i, 0, 3) = sum / 3.0f;
  }
  return phase;
}

}  // namespace welkin::optics
