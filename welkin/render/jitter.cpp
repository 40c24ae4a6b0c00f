// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/jitter.h"

#include <cmath>
#include <cstdint>

namespace welkin::render {

glm::vec2 jitterPx(int i) {
  const auto part = [i](double a) { return static_cast<float>(std::fmod(0.5 + a * i, 1.0)) - 0.5f; };
  return {part(0.7548776662466927), part(0.5698402909980532)};
}

glm::vec2 jitterStep(int i) {
  std::uint32_t x = 0, y = 0, half = 1u << 31, second = half;
  for (auto bits = static_cast<std::uint32_t>(i); bits != 0; bits >>= 1, half >>= 1, second ^= second >> 1)
    if (bits & 1u) {
      x ^= half;
      y ^= second;
    }
  return glm::vec2(x >> 8, y >> 8) * 0x1p-24f;
}

}  // namespace welkin::render
