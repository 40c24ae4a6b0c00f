// SPDX-License-Identifier: Apache-2.0
// What a time comes to for the lattice of value noise (value.h). Private to noise/.
#pragma once

#include <array>
#include <cstdint>

namespace welkin::noise {

// Lattice points meet whole times at one of so many phases, evenly over a cell of time. As many as the
// longest vector has floats, which looks their weights up.
inline constexpr int kTimePhases = 16;

struct ValueClock {
  int taps = 0;                          // hashes that are interpolated in time; 0: there is no time
  int later = 0;                         // points of phases from here on are past their next whole time
  std::array<std::uint64_t, 5> first{};  // OwnRow::first of the noises of the whole times around
  std::array<std::array<double, kTimePhases>, 4> weight{};  // of each tap, by phase
};

}  // namespace welkin::noise
