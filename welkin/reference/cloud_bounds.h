// SPDX-License-Identifier: Apache-2.0
// Bounds of a cloud's density over a box: interval arithmetic over the formulas of shaders/lib/clouds.glsl,
// in their order, with the least and greatest texel that a box reaches in the place of each noise. Linear
// filtering stays between its texels and every other step is monotone in each of its arguments, so that no
// point of the box is beyond the bounds but by the rounding of floats, for which there is a margin.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/field/cloud_field.h"

namespace welkin::reference {

struct Interval {
  float low = 0.0f, high = 0.0f;
};

// A box of cloud positions: metres east and north along the ground, height above it.
struct CloudBox {
  glm::vec3 low{0.0f}, high{0.0f};
};

// Least and greatest values of a tiling texture over boxes, from a pyramid of them.
class TexelExtremes {
 public:
  static constexpr int kMostChannels = 4;
  using Channels = std::array<Interval, kMostChannels>;

  TexelExtremes() = default;
  // `values` are `channels` interleaved, up to kMostChannels; nz is 1 for a picture.
  TexelExtremes(const std::vector<float>& values, int nx, int ny, int nz, int channels);
  // Of linear filtering anywhere in the box of texture coordinates, which may be of any size.
  Channels over(glm::vec3 low, glm::vec3 high) const;

 private:
  // Of each cell and channel the least value, its sign turned, and the greatest, in steps and rounded up:
  // what holds of several cells is the greatest of each. Rows go on at their end as they begin, so that
  // kMostCells may be read from anywhere.
  struct Level {
    int n[3];
    std::size_t rowSize;
    std::vector<std::int16_t> cells;
    Level(int nx, int ny, int nz, int cellSize);
    std::int16_t* row(int y, int z) { return &cells[static_cast<std::size_t>(z * n[1] + y) * rowSize]; }
    const std::int16_t* row(int y, int z) const {
      return &cells[static_cast<std::size_t>(z * n[1] + y) * rowSize];
    }
    void repeatRows(int cellSize);
  };
  static constexpr int kMostCells = 12;  // along a side of what is looked up at one level

  int channels_ = 1;   // in memory: 1 or kMostChannels
  float step_ = 0.0f;  // of what cells hold
  std::vector<Level> levels_;
};

class CloudBounds {
 public:
  explicit CloudBounds(const field::CloudField& field);

  struct Layer {
    float highest = 0.0f, lowest = 0.0f;  // extinction, 1/m
    bool full = false;                    // all of the box is so deep in the cloud that only height counts
  };
  Layer layer(std::size_t index, const CloudBox& box) const;

 private:
  const field::CloudField& field_;
  TexelExtremes placement_, shape_, detail_;
};

}  // namespace welkin::reference
