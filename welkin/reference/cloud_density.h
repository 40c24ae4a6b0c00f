// SPDX-License-Identifier: Apache-2.0
// The clouds' extinction at points, as field/cloud_field.h has it, for those who ask for millions of points:
// the same formula over the same noises, which lie in memory as vectors of four read them.
#pragma once

#include <glm/vec3.hpp>

#include "welkin/field/cloud_field.h"

namespace welkin::reference {

class CloudDensity {
 public:
  explicit CloudDensity(const field::CloudField& field);  // outlives this

  // Of one layer at a cloud position (lib/clouds.glsl), 1/m.
  float extinction(std::size_t layer, const glm::vec3& q) const;

 private:
  const field::CloudField& field_;
  Image<float> placement_;  // 4 channels, the last 0
};

}  // namespace welkin::reference
