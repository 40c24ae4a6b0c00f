// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/cover_ahead.h"

#include <cmath>
#include <limits>

namespace welkin::render {

void CoverAhead::prepare(scene::SkyState& state) {
  if (state.coverKeyS == 0.0) return;
  pace_.moveTo(state.secondsAfter, state.coverKeyS);
  if (atS_ != pace_.next()) {
    making_.start(state.scene, state.weather, state.clouds->sharedNoise(), state.calibration, pace_.next());
    atS_ = pace_.next();
    if (!state.coverKeyAhead) {  // room for it
      state.coverKeyAhead = making_.key();
      state.coverKeyAhead->atS = std::numeric_limits<double>::quiet_NaN();
    }
    return;
  }
  const int upTo = static_cast<int>(std::ceil(pace_.due() * making_.parts()));
  making_.computeTo(upTo);
  if (upTo == making_.parts()) *state.coverKeyAhead = making_.key();
}

}  // namespace welkin::render
