// SPDX-License-Identifier: Apache-2.0
// Phase functions by colour, from tables whose rows stand close where much changes.
#pragma once

#include <array>
#include <span>

#include "welkin/core/image.h"

namespace welkin::optics {

struct PhaseRow {
  float angleDeg;              // of scattering
  std::array<float, 3> phase;  // 1/sr: red, green, blue
};

// Fills the first three channels of a picture one texel high, at scattering angles from 0 to pi in equal
// steps, the first and the last texel included. rows: from 0 to 180 degrees, rising; linear between them.
void fillColours(std::span<const PhaseRow> rows, Image<float>& phase);

}  // namespace welkin::optics
