// SPDX-License-Identifier: Apache-2.0
// Floats in order as integers: what sorts and counts by digits needs.
#pragma once

#include <bit>
#include <cstdint>

namespace welkin {

// A key whose order as an integer is that of the float (not a NaN): negative numbers are stored as sign and
// magnitude.
constexpr std::uint32_t orderedKey(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 becomes +0, its equal
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}

// The float of a key.
constexpr float floatOfKey(std::uint32_t key) {
  return std::bit_cast<float>(key >> 31 ? key & 0x7fffffffu : ~key);
}

}  // namespace welkin
