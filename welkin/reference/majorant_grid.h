// SPDX-License-Identifier: Apache-2.0
// Upper bounds of the clouds' extinction on a grid of bricks, made where light comes by: what null-collision
// tracking steps by. Bricks are some hundred metres across near the eye and wider far from it; slices between
// the layers' bases and tops are cut to match.
//
// Safe to use from several threads: a brick's bound does not depend on who asks first.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "welkin/reference/cloud_bounds.h"

namespace welkin::reference {

class MajorantGrid {
 public:
  // Boxes are taken to be wider than they are by this much on all sides: so far may a position be from
  // where it is looked up.
  static constexpr float kMarginM = 0.5f;

  // layers: indices of those that are traced.
  MajorantGrid(const field::CloudField& field, std::vector<int> layers);
  ~MajorantGrid();
  MajorantGrid(const MajorantGrid&) = delete;
  MajorantGrid& operator=(const MajorantGrid&) = delete;

  float lowM() const { return edges_.front(); }  // heights between which there may be cloud
  float highM() const { return edges_.back(); }
  std::span<const int> layers() const { return layers_; }

  struct Brick {
    float majorant = 0.0f;    // 1/m
    std::uint8_t layers = 0;  // those that may have cloud here: bit i for the field's layer i
    std::uint8_t full = 0;    // those of them that are full everywhere here
    CloudBox box;             // in which all of this holds
  };
  // q: within lowM() and highM(); else the answer is of the nearest slice. Beyond kReachM there is no cloud.
  Brick at(glm::vec3 q) const;

  static constexpr float kReachM = 1024e3f;  // of the grid from the eye, east and north

 private:
  struct Tile;
  const Tile& tileAt(int x, int y) const;
  std::uint64_t compute(const CloudBox& box) const;
  int sliceAt(float z) const;

  CloudBounds bounds_;
  std::vector<int> layers_;
  std::vector<float> edges_;  // of slices, rising
  std::vector<int> sliceGuide_;
  mutable std::vector<std::atomic<Tile*>> tiles_;
};

}  // namespace welkin::reference
