// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "welkin/noise/noise.h"

int main() {
  const welkin::noise::Noise noise(welkin::noise::NoiseParams{});
  return std::isfinite(noise.sample({0.3, 0.7, 0.1})) ? 0 : 1;
}
