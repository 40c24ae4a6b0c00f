// SPDX-License-Identifier: Apache-2.0
// A few cumulus clouds as metaballs, to fill skies with: maps of towers (field/cumulus_tower.h) fitted at
// several levels of detail (fit/fit_metaballs.h).
#pragma once

#include <array>
#include <vector>

#include "welkin/field/metaballs.h"

namespace welkin::scene {

inline constexpr std::size_t kLibraryLevels = 3;

struct LibraryCloud {
  // As wide as 1, on the plane z = 0, in the middle of it; density about 1 inside. Fewest balls first.
  std::array<std::vector<field::Metaball>, kLibraryLevels> levels;
  std::array<double, kLibraryLevels> radii{};  // the median of each level's balls
  // All of it in one ball, as wide on the average and holding as much: its shadow from far away.
  std::vector<field::Metaball> whole;
  double height = 1.0;
};

// Towers, about as high as wide, and flat ones. Made at the first call, in a second or two, and then kept;
// the same on every call and in any number of threads. Safe to call from several threads.
const std::vector<LibraryCloud>& cumulusTowers();
const std::vector<LibraryCloud>& flatCumulus();

}  // namespace welkin::scene
