// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/cover_ahead.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace welkin::render {

void CoverAhead::prepare(scene::SkyState& state) {
  constexpr double kReady = 0.9;  // share of the interval by which all is done
  const double interval = state.coverKeyS;
  if (interval == 0.0) return;
  const double before = std::floor(state.secondsAfter / interval) * interval;
  const bool forward = state.secondsAfter >= lastS_;
  const double passed = (state.secondsAfter - before) / interval, share = forward ? passed : 1.0 - passed;
  const double next = forward ? before + 2.0 * interval : before - interval;
  lastS_ = state.secondsAfter;
  if (atS_ != next) {
    making_.start(state.scene, state.weather, state.clouds->sharedNoise(), state.calibration, next);
    atS_ = next;
    startedAt_ = share;
    if (!state.coverKeyAhead) {  // room for it
      state.coverKeyAhead = making_.key();
      state.coverKeyAhead->atS = std::numeric_limits<double>::quiet_NaN();
    }
    return;
  }
  const double ready = std::max(kReady, 0.5 * (1.0 + startedAt_));
  const double done = std::min((share - startedAt_) / (ready - startedAt_), 1.0);
  const int upTo = static_cast<int>(std::ceil(done * making_.parts()));
  making_.computeTo(upTo);
  if (upTo == making_.parts()) *state.coverKeyAhead = making_.key();
}

}  // namespace welkin::render
