// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs (field/metaballs.h) as a medium that light is traced through by null collisions, beside
// the clouds of cloud_medium.h and with the same methods.
//
// The extinction of a cloud is max(sum rho f(r / R), 0) of its own balls, and that of all of them their sum:
// clouds are media that do not know of one another, so that the nearest of their collisions is the
// collision, and the product of their transmittances the transmittance. Each cloud has a grid of bricks that
// list the balls which reach into them, for the field, and bound it, for the majorant; it is made when light
// first comes by.
//
// Frame: sphere.h's. Immutable to the outside and safe to use from several threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "welkin/core/random.h"
#include "welkin/reference/sphere.h"
#include "welkin/scene/metaballs.h"

namespace welkin::reference {

class MetaballMedium {
 public:
  // Densities are extinctions, 1/m.
  explicit MetaballMedium(const scene::CloudBalls& balls);
  ~MetaballMedium();
  MetaballMedium(MetaballMedium&&) noexcept;

  bool empty() const { return clouds_.empty(); }

  struct Collision {
    double t = 0.0;  // along the ray
    scene::MetaballPhase phase = scene::MetaballPhase::kDroplets;
    double albedo = 1.0;
  };
  // The first collision in [0, end), or none.
  std::optional<Collision> collide(const Ray& ray, double end, Random& random) const;

  // An estimate of the transmittance over [0, end), in [0, 1]: its mean is the transmittance.
  double transmittance(const Ray& ray, double end, Random& random) const;

  // Extinction at a place, and a bound of it in the bricks that hold the place, 1/m.
  double extinction(const glm::dvec3& p) const;
  double majorant(const glm::dvec3& p) const;

 private:
  class Cloud;
  // Of a tree of boxes: two nodes further on, or one cloud.
  struct Node {
    field::Box box;
    std::uint32_t right = 0;  // the left one follows; 0: a cloud
    std::uint32_t cloud = 0;
  };
  std::uint32_t addNode(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end);
  // Calls f(cloud, t0, t1) for the clouds whose boxes the ray meets in [0, end), until it returns a lower
  // end, at most 0 to stop.
  template <class F>
  void each(const Ray& ray, double end, F&& f) const;

  std::vector<std::unique_ptr<Cloud>> clouds_;
  std::vector<Node> nodes_;  // the first is the root
};

}  // namespace welkin::reference
