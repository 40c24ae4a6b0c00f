// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs for scenes, in files that go when the test does.
#pragma once

#include <vector>

#include "tests/testing/scratch_folder.h"
#include "welkin/field/metaballs.h"
#include "welkin/scene/metaballs.h"

namespace welkin::testing {

class MetaballFolder {
 public:
  // At a place in the sky: east, north, above the ground. Densities are extinctions, 1/m.
  scene::MetaballCloud cloud(const std::vector<field::Metaball>& balls, const glm::dvec3& positionM) const;
  // A cloud of one ball.
  scene::MetaballCloud ball(double radiusM, double extinctionPerM, const glm::dvec3& positionM) const;
  // Of these levels, the fewest balls first.
  scene::MetaballCloud levels(const std::vector<std::vector<field::Metaball>>& levels,
                              const glm::dvec3& positionM) const;

 private:
  ScratchFolder folder_;
  mutable int files_ = 0;
};

// Some hundred balls in a lump some 1000 m across, about the origin, of one extinction each.
std::vector<field::Metaball> lumpOfBalls(int count, double extinctionPerM);

}  // namespace welkin::testing
