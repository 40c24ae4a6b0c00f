// SPDX-License-Identifier: Apache-2.0
// What of many rays lies where the clouds of a cloud_medium.h are, and pieces of it as lines of cloud
// positions: CloudMedium::stretches() and lineFrom(), for vectors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "welkin/reference/cloud_medium.h"
#include "welkin/reference/sphere.h"

namespace welkin::reference {

// An array of each quantity, in the order in which rays were added.
struct alignas(64) RayPieces {
  template <class T>
  struct alignas(64) Each : std::array<T, kCloudLanes> {};
  template <class T>
  struct Vectors {
    Each<T> x, y, z;
  };

  std::size_t count = 0;
  Each<std::uint8_t> lane;  // for the caller
  Vectors<double> from, way;
  Each<double> end;    // of rays
  Each<double> start;  // of pieces, along the rays
  Each<float> length;

  // At most kCloudLanes.
  void add(std::size_t toLane, const Ray& ray) {
    const std::size_t k = count++;
    lane[k] = static_cast<std::uint8_t>(toLane);
    from.x[k] = ray.from.x, from.y[k] = ray.from.y, from.z[k] = ray.from.z;
    way.x[k] = ray.way.x, way.y[k] = ray.way.y, way.z[k] = ray.way.z;
  }

  // Answers.
  Each<double> starts[2], ends[2];            // of stretches of [0, end)
  Vectors<float> place, slope, inverse;       // lines: CloudLine
  Vectors<float> placeInSpace, againInSpace;  // where the pieces begin and end
};

void findStretches(const CloudMedium& medium, RayPieces& rays);
// Of pieces longer than 0.
void layLines(const Sphere& earth, RayPieces& rays);

}  // namespace welkin::reference
