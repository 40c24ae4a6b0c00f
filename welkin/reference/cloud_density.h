// SPDX-License-Identifier: Apache-2.0
// The clouds' extinction at points, as field/cloud_field.h has it, for those who ask for millions of points:
// the same formula over the same noises, which lie in memory as vectors of four read them. For many points at
// a time: cloud_density-inl.h.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "welkin/field/cloud_field.h"

namespace welkin::reference {

inline constexpr std::size_t kCloudLanes = 64;  // that are walked together: whole vectors of any machine

// Texels of 16 bits in steps, whose sides are powers of two: the placement map has four channels, the noises
// one and each row of theirs its first texel again behind its last. A step is some 1e-4 of a deviation.
struct CloudTexture {
  const std::int16_t* texels = nullptr;
  int nx = 1, ny = 1, nz = 1;
  int rowTexels = 1;  // of noises
  float step = 1.0f;
};
struct CloudTextures {
  CloudTexture placement, shape, detail;
};

// A layer, and what its numbers are divided by; of the patches' angle, cosine and sine over their period.
struct CloudLayerFactors {
  explicit CloudLayerFactors(const field::CloudLayer& l);

  field::CloudLayer layer;
  float perDepth, perStretch, patchCosine, patchSine, perCell, perShapeStretch, perShapeTall, perShape,
      perDetail;
  float perShapeAmount, perBottomSoft, perTopSoft;
  float anvilFrom, perAnvil, anvilShape, anvilEdge, anvilExtinction;
};

class CloudDensity {
 public:
  explicit CloudDensity(const field::CloudField& field);  // outlives this

  // Of one layer at a cloud position (lib/clouds.glsl), 1/m.
  float extinction(std::size_t layer, const glm::vec3& q) const;

  // The same of many points, as cloud_density-inl.h has it: from noises of 16 bits, as pictures are drawn
  // from, to 1e-3 of the most that the layer has. to: as many as there are points.
  void extinctions(std::size_t layer, std::span<const glm::vec3> q, float* to) const;

  const CloudTextures& textures() const { return textures_; }
  std::span<const CloudLayerFactors> layers() const { return layers_; }

 private:
  const field::CloudField& field_;
  Image<float> placement_;  // 4 channels, the last 0
  std::vector<std::int16_t> texels_[3];
  CloudTextures textures_;
  std::vector<CloudLayerFactors> layers_;
};

}  // namespace welkin::reference
