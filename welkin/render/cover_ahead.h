// SPDX-License-Identifier: Apache-2.0
// Cover calibrated ahead of time, for frame loops: while time runs through an interval between key instants,
// the one after it is made a portion at a time, so that no frame has to wait for it
// (scene/cover_calibration.h).
#pragma once

#include <optional>

#include "welkin/render/key_pace.h"
#include "welkin/scene/cover_calibration.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {

class CoverAhead {
 public:
  // Forgets what is under way. Before prepare() for another scene.
  void reset() {
    atS_.reset();
    pace_ = {};
  }
  // One portion more of the key instant that comes next, into state.coverKeyAhead once it is complete. Of
  // every frame, after the state has moved. Allocates nothing after the first two calls for a scene.
  void prepare(scene::SkyState& state);

 private:
  std::optional<double> atS_;  // the key instant under way
  KeyPace pace_;
  scene::CoverKeyInProgress making_;
};

}  // namespace welkin::render
