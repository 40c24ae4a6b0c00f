// SPDX-License-Identifier: Apache-2.0
// Frame times of thin clouds beside the table of G. Tarantilis 2004, and as multiples of a yardstick measured
// in the same run: one full-screen blended quad with one mipmapped trilinear fetch. The layer fills the view.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace welkin::bench {

struct FrameTime {
  std::string name;
  double ms = 0.0;                  // wall clock, finished on the device, median
  double yardsticks = 0.0;          // as a multiple of the first row's
  std::optional<double> share;      // of a whole frame's rate: of the empty sky's
  std::optional<double> thesisFps;  // in 2004
};

struct FrameTable {
  std::string device;
  int width = 0, height = 0;  // pixels
  int rounds = 0;             // that the medians are of
  std::vector<FrameTime> rows;
};

// Each round measures every case once, so that what else the machine does falls on all alike. Throws GpuError
// where there is no EGL.
FrameTable measureFrames();

}  // namespace welkin::bench
