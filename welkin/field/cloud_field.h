// SPDX-License-Identifier: Apache-2.0
// The density of all clouds of a scene: layers over one set of noise textures. Extinction in 1/m as a pure
// function of position; the instant is in the layers' displacements. What is const is safe to share between
// threads.
//
// Frame: east-north-up, origin on the ground under the eye; the ground is a sphere of radius earthRadiusM().
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/field/cloud_layer.h"

namespace welkin::field {

// The noise that clouds are made of; tileable. Depends on the seed alone.
struct CloudNoise {
  Image<float> placement;  // 3 channels: round cells, fractal noise, patches; each standard normal
  Volume<float> shape;     // 1 channel, mean 0, variance 1
  Volume<float> detail;    // the same, finer
};
std::shared_ptr<const CloudNoise> makeCloudNoise(std::uint64_t seed);

class CloudField {
 public:
  // Throws ParameterError for more than kMaxLayers layers (cloud_layer.glsl).
  CloudField(std::shared_ptr<const CloudNoise> noise, std::vector<CloudLayer> layers, double groundAltitudeM);

  const CloudNoise& noise() const { return *noise_; }
  const std::shared_ptr<const CloudNoise>& sharedNoise() const { return noise_; }
  std::span<const CloudLayer> layers() const { return layers_; }
  // The same layers at another instant: as many as there are.
  void setLayers(std::span<const CloudLayer> layers) { std::ranges::copy(layers, layers_.begin()); }
  double earthRadiusM() const { return earthRadiusM_; }

  // Extinction at p, 1/m.
  float extinction(glm::vec3 p) const;

  // Optical depth along a ray from `from` through everything, or at least `enough` once it is reached. `only`
  // picks one layer; -1: all.
  float opticalDepth(glm::vec3 from, glm::vec3 direction, float enough, int only = -1) const;

 private:
  std::shared_ptr<const CloudNoise> noise_;
  std::vector<CloudLayer> layers_;
  double earthRadiusM_;
};

}  // namespace welkin::field
