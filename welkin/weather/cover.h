// SPDX-License-Identifier: Apache-2.0
// From the amounts of a report to the cover of each layer.
//
// A report's amounts are cumulative: "SCT020 BKN040" says that the layer at 2,000 ft covers 3 to 4 oktas, and
// that as much of the sky as an observer sees covered by everything up to 4,000 ft is 5 to 7 oktas (WMO-No.
// 306, 15.9.1). What part of the upper layer the lower one hides is not told; the layers are taken as
// independent of one another (random overlap, right for layers far apart), so with total covers C as
// fractions
//
//   C_i = 1 - (1 - C_(i-1)) (1 - own_i)     and     own_i = (C_i - C_(i-1)) / (1 - C_(i-1)).
//
// A category is a range (WMO code table D-8). One layer of it takes the middle of the range; several spread
// over the range, because an amount that grows within one category is still reported with it: two FEW are 1
// and 2 oktas in total, two SCT 3 and 4, two BKN 5 and 7, three BKN 5, 6 and 7.
//
// Where the amount is no more than what is beneath (cumulonimbus is reported with its own amount in many
// countries, and some report all layers so), the layer gets a small cover of its own that keeps the total
// inside the category beneath. A layer over an overcast cannot be seen from the ground and gets its
// category's middle.
#pragma once

#include <span>
#include <vector>

#include "welkin/weather/metar.h"

namespace welkin::weather {

struct CoverStack {
  std::vector<double> ownOktas;  // a layer each
  double totalOktas = 0.0;       // of all together
};

// `covers` from the lowest layer up. An unknown amount counts as few.
CoverStack stackCover(std::span<const MetarCover> covers);

// Middle of a category's range, in oktas.
double middleOktas(MetarCover cover);

// What two independent covers hide together.
double combinedOktas(double a, double b);

}  // namespace welkin::weather
