// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/cover.h"

#include <algorithm>
#include <cstddef>

namespace welkin::weather {
namespace {

struct Range {
  double least, most;
};

// Code table D-8: FEW 1 to 2, SCT 3 to 4, BKN 5 to 7, OVC 8.
Range rangeOf(MetarCover cover) {
  switch (cover) {
    case MetarCover::kFew:
    case MetarCover::kUnknown:
      return {1.0, 2.0};
    case MetarCover::kScattered:
      return {3.0, 4.0};
    case MetarCover::kBroken:
      return {5.0, 7.0};
    case MetarCover::kOvercast:
      return {8.0, 8.0};
  }
  return {1.0, 2.0};
}

// A layer whose amount is no more than what is beneath makes the total grow by half an okta where its
// category has room for it.
constexpr double kSmallOktas = 0.5;

// Beyond the category's end the growth halves what is left of the half okta that rounds down, for every such
// layer.
double smallGrowth(double below, double endOfCategory) {
  if (below < endOfCategory) return std::min(endOfCategory - below, kSmallOktas);
  return 0.5 * std::max(endOfCategory + 0.5 - below, 0.0);
}

}  // namespace

double middleOktas(MetarCover cover) {
  const Range r = rangeOf(cover);
  return 0.5 * (r.least + r.most);
}

double combinedOktas(double a, double b) {
  return 8.0 - (8.0 - a) * (8.0 - b) / 8.0;
}

CoverStack stackCover(std::span<const MetarCover> covers) {
  // A layer grows the total when no layer beneath has a larger category; only those share their category's
  // range.
  std::vector<bool> grows;
  double largest = 0.0;
  for (const MetarCover c : covers) {
    grows.push_back(rangeOf(c).least >= largest);
    largest = std::max(largest, rangeOf(c).least);
  }

  CoverStack stack;
  double endOfCategory = 0.0;
  for (std::size_t i = 0; i < covers.size(); ++i) {
    const double below = stack.totalOktas;
    if (below >= 8.0) {
      stack.ownOktas.push_back(middleOktas(covers[i]));
      continue;
    }
    double total = 0.0;
    if (grows[i]) {
      const Range range = rangeOf(covers[i]);
      int count = 0, before = 0;
      for (std::size_t k = 0; k < covers.size(); ++k) {
        if (!grows[k] || rangeOf(covers[k]).least != range.least) continue;
        ++count;
        if (k < i) ++before;
      }
      total = count == 1 ? middleOktas(covers[i])
                         : range.least + (range.most - range.least) * before / (count - 1);
    }
    if (grows[i]) endOfCategory = rangeOf(covers[i]).most;
    if (total <= below) total = below + smallGrowth(below, endOfCategory);
    stack.ownOktas.push_back(8.0 * (total - below) / (8.0 - below));
    stack.totalOktas = total;
  }
  return stack;
}

}  // namespace welkin::weather
