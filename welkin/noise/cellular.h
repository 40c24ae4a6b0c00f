// SPDX-License-Identifier: Apache-2.0
// Cellular noise: S. Worley 1996, "A Cellular Texture Basis Function". One feature point a lattice cell,
// tileable. Immutable after construction; safe to share between threads.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace welkin::noise {

class Cellular {
 public:
  // `period` cells an axis, each >= 1; a point uniformly placed in each.
  Cellular(std::uint64_t seed, glm::ivec3 period);

  // Distance from p (in cells; wrapped) to the nearest feature point, F1. 0 to sqrt(3); typically 0.5 in 3D,
  // 0.4 in 2D.
  float f1(float x, float y, float z) const;
  // The same within the plane z = 0, for maps: points of the first slice of cells, distances without their z.
  float f1(float x, float y) const;

  // out[i] = f1((i + 0.5) * step, y, z) for a whole row, several times faster; equal but for rounding.
  // step > 0 and out.size() * step <= period.x.
  void f1Row(std::span<float> out, float step, float y, float z) const;
  void f1Row(std::span<float> out, float step, float y) const;

 private:
  const glm::vec3& point(int i, int j, int k) const {
    return points_[(static_cast<std::size_t>(k) * (period_.y + 2) + j) * (period_.x + 2) + i];
  }
  glm::ivec3 period_;
  std::vector<glm::vec3> points_;  // with a border of one wrapped cell on each side
};

}  // namespace welkin::noise
