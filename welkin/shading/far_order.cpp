// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/far_order.h"

#include <algorithm>
#include <numeric>

namespace welkin::shading {
namespace {

// An insertion that has moved so many places for each thing had better begin anew.
constexpr std::size_t kMostMoves = 24;

}  // namespace

std::span<const std::uint32_t> FarOrder::sort(std::span<const float> distances) {
  comparisons_ = 0;
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    ++comparisons_;
    return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
  };
  fresh_ = order_.size() != distances.size();
  if (fresh_) {
    order_.resize(distances.size());
    std::iota(order_.begin(), order_.end(), 0u);
  }
  std::size_t moves = 0;
  for (std::size_t i = 1; i < order_.size() && !fresh_; ++i) {
    const std::uint32_t own = order_[i];
    std::size_t to = i;
    for (; to > 0 && before(own, order_[to - 1]); --to, ++moves) order_[to] = order_[to - 1];
    order_[to] = own;
    fresh_ = moves > kMostMoves * order_.size();
  }
  if (fresh_) std::sort(order_.begin(), order_.end(), before);
  return order_;
}

}  // namespace welkin::shading
