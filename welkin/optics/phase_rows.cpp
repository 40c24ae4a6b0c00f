// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/phase_rows.h"

#include <cstddef>

namespace welkin::optics {

void fillColours(std::span<const PhaseRow> rows, Image<float>& phase) {
  std::size_t row = 0;  // the one before the angle
  for (int i = 0; i < phase.width; ++i) {
    const float deg = 180.0f * static_cast<float>(i) / static_cast<float>(phase.width - 1);
    while (row + 2 < rows.size() && rows[row + 1].angleDeg <= deg) ++row;
    const PhaseRow &low = rows[row], &high = rows[row + 1];
    const float share = (deg - low.angleDeg) / (high.angleDeg - low.angleDeg);
    for (std::size_t c = 0; c < 3; ++c)
      phase.at(i, 0, static_cast<int>(c)) = low.phase[c] + share * (high.phase[c] - low.phase[c]);
  }
}

}  // namespace welkin::optics
