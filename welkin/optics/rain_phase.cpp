// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/rain_phase.h"

#include <cstddef>
#include <iterator>

#include "welkin/optics/rain_table.h"

namespace welkin::optics {

Image<float> rainPhase() {
  Image<float> phase(kRainAngles, 1, 3);
  std::size_t row = 0;  // the one before the angle
  for (int i = 0; i < kRainAngles; ++i) {
    const float deg = 180.0f * static_cast<float>(i) / static_cast<float>(kRainAngles - 1);
    while (row + 2 < std::size(detail::kRainRows) && detail::kRainRows[row + 1].angleDeg <= deg) ++row;
    const detail::RainRow &low = detail::kRainRows[row], &high = detail::kRainRows[row + 1];
    const float share = (deg - low.angleDeg) / (high.angleDeg - low.angleDeg);
    for (std::size_t c = 0; c < 3; ++c)
      phase.at(i, 0, static_cast<int>(c)) = low.phase[c] + share * (high.phase[c] - low.phase[c]);
  }
  return phase;
}

}  // namespace welkin::optics
