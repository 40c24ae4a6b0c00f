// SPDX-License-Identifier: Apache-2.0
// Things in the order of their distances, the farthest first, kept from frame to frame. Pure.
//
// Insertion from the last order: next to nothing where little has moved. Where much has, or the number of
// things is another, it is a fresh sort. The order is total, by distance and then by number, so that it is
// the same however it was found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace welkin::shading {

class FarOrder {
 public:
  void reserve(std::size_t count) { order_.reserve(count); }

  // Numbers of the distances, which are finite. Allocates nothing for as many as there have been.
  std::span<const std::uint32_t> sort(std::span<const float> distances);

  std::span<const std::uint32_t> order() const { return order_; }
  // What the last sort cost: pairs that it compared, and whether it began anew.
  std::size_t comparisons() const { return comparisons_; }
  bool isFresh() const { return fresh_; }

 private:
  std::vector<std::uint32_t> order_;
  std::size_t comparisons_ = 0;
  bool fresh_ = true;
};

}  // namespace welkin::shading
