// SPDX-License-Identifier: Apache-2.0
// Improved gradient noise: K. Perlin 2002, "Improving Noise". Three dimensions, any integer period an axis.
// Immutable after construction; safe to share between threads.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace welkin::noise {

class Perlin {
 public:
  // Perlin's published permutation table; reproduces his published values.
  Perlin();
  // A permutation shuffled by a portable generator.
  explicit Perlin(std::uint64_t seed);

  // Noise at p, in lattice cells. Standard deviation 0.27, range about [-0.95, 0.95], 0 on lattice points,
  // repeats every 256.
  double operator()(double x, double y, double z) const;

  // The same with the lattice wrapped to `period` cells an axis (each >= 1): n(p + period) == n(p). Seamless
  // for any period, since both corners of a cell are wrapped.
  float periodic(float x, float y, float z, glm::ivec3 period) const;

  // out[i] += weight * periodic((i + 0.5) * step, y, z, period) for a whole row, several times faster; equal
  // but for rounding. step > 0.
  void addRow(std::span<float> out, float weight, float step, float y, float z, glm::ivec3 period) const;

 private:
  std::array<std::uint8_t, 512> p_;
};

}  // namespace welkin::noise
