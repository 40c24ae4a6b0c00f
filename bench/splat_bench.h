// SPDX-License-Identifier: Apache-2.0
// How long a frame of metaballs takes, both passes: what `welkin bench splat` prints.
#pragma once

#include <string>
#include <vector>

namespace welkin::bench {

struct SplatTime {
  int balls = 0;
  double ms = 0.0;
};

struct SplatTable {
  std::string device;
  int width = 0, height = 0;
  int rounds = 0;  // medians of so many frames
  std::vector<SplatTime> rows;
};

// A cloud of some 400 m, 1 km away, whose balls are the smaller the more there are; they move in every frame.
SplatTable measureSplats();

}  // namespace welkin::bench
