// SPDX-License-Identifier: Apache-2.0
// Balls taken from where they do little to where they are missed. Private to fit/.
#pragma once

#include <vector>

#include "welkin/fit/refine.h"

namespace welkin::fit {

struct Move {
  std::size_t count = 1;   // balls, those that the fit would miss least,
  std::size_t spared = 0;  // but for so many
  std::size_t passed = 0;  // best places that are passed over for the first of them
};

// Takes balls away and puts as many where a ball takes most off the residual, one after another (S. Mallat
// and Z. Zhang 1993, "Matching Pursuits with Time-Frequency Dictionaries"). What a ball is worth is what its
// neighbour that could best do its work, by a change of its weight, centre and radius, cannot make up for.
// The result is not refined yet, and mostly worse; it has fewer balls if nothing is left to be fitted.
std::vector<GridBall> relocated(const DensityGrid& data, const std::vector<GridBall>& balls, const Move& move,
                                const RefineParams& params, const FitControl& control);

// The way round a minimum that no move leads out of, such as one ball over two that belong there with a third
// that mends it elsewhere: `more` balls than there are, refined, and then those that would be missed least
// taken away again, one after another and refined each time. Given up where even more balls leave |r|^2 above
// `enough`: then it returns infinity, with balls of no use. Otherwise |r|^2, as refine().
struct Detour {
  std::size_t more = 1;
  std::size_t passed = 0;  // as in Move
  double enough = 0.0;
};
double goRound(const DensityGrid& data, std::vector<GridBall>& balls, const Detour& detour,
               const RefineParams& params, const FitControl& control);

}  // namespace welkin::fit
