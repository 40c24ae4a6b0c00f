// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cloud_field.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/noise/tile.h"

namespace welkin::field {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/clouds.glsl"

constexpr int kPlacementSize = 512;
constexpr int kShapeSize = 128;
constexpr int kDetailSize = 64;

// Steps through a layer: fine enough to cross it in some fifty and to sample its blobs along a slanted ray,
// coarser far away, where a blob is small in the sky. Several times finer steps change the measured cover of
// a layer by less than 0.1 okta.
constexpr float kShareOfStretch = 1.0f / 48.0f, kShareOfBlob = 0.1f, kShareOfDistance = 0.003f;

// Size of what a layer's cloud is made of: cells are a twelfth of their pattern's period, blobs of the 3D
// noise a fifth.
float blobM(const CloudLayer& layer) {
  return std::min(layer.cellM / 12.0f, layer.shapeM / 5.0f);
}

// Ray parameters at which a sphere of radius r is crossed; p relative to the ground under the eye. False:
// missed.
bool crossings(glm::vec3 p, glm::vec3 d, double earthRadius, double height, double& t0, double& t1) {
  const double px = p.x, py = p.y, pz = earthRadius + p.z;
  const double b = px * d.x + py * d.y + pz * d.z;
  const double r = earthRadius + height;
  const double c = px * px + py * py + pz * pz - r * r;
  const double disc = b * b - c;
  if (disc <= 0.0) return false;
  const double root = std::sqrt(disc);
  t0 = -b - root;
  t1 = -b + root;
  return true;
}

}  // namespace

std::shared_ptr<const CloudNoise> makeCloudNoise(std::uint64_t seed) {
  auto noise = std::make_shared<CloudNoise>();
  noise->placement = Image<float>(kPlacementSize, kPlacementSize, 3);
  const noise::Octaves cells{.octaves = 2, .frequency = 12, .lacunarity = 2, .persistence = 0.3f};
  const noise::Octaves fractal{.octaves = 6, .frequency = 8, .lacunarity = 2, .persistence = 0.5f};
  const noise::Octaves patches{.octaves = 4, .frequency = 6, .lacunarity = 2, .persistence = 0.45f};
  const Image<float> maps[3] = {noise::gaussianCellMap(hashOf(seed, 1), kPlacementSize, cells),
                                noise::gaussianMap(hashOf(seed, 2), kPlacementSize, fractal),
                                noise::gaussianMap(hashOf(seed, 3), kPlacementSize, patches)};
  for (std::size_t i = 0; i < maps[0].data.size(); ++i)
    for (int c = 0; c < 3; ++c) noise->placement.data[3 * i + c] = maps[c].data[i];
  noise->shape =
      noise::billowVolume(hashOf(seed, 4), kShapeSize,
                          {.octaves = 4, .frequency = 5, .lacunarity = 2, .persistence = 0.5f}, 0.85f);
  noise->detail =
      noise::billowVolume(hashOf(seed, 5), kDetailSize,
                          {.octaves = 3, .frequency = 5, .lacunarity = 2, .persistence = 0.6f}, 0.9f);
  return noise;
}

CloudField::CloudField(std::shared_ptr<const CloudNoise> noise, std::vector<CloudLayer> layers,
                       double groundAltitudeM)
    : noise_(std::move(noise)), layers_(std::move(layers)), earthRadiusM_(kEarthRadiusM + groundAltitudeM) {
  if (layers_.size() > static_cast<std::size_t>(kMaxLayers))
    throw ParameterError("a sky has at most " + std::to_string(kMaxLayers) +
                         " layers of cloud and rain, not " + std::to_string(layers_.size()));
}

float CloudField::extinction(glm::vec3 p) const {
  const sampler2D placement{&noise_->placement, Wrap::kRepeat, Wrap::kRepeat};
  const sampler3D shape{&noise_->shape, Wrap::kRepeat}, detail{&noise_->detail, Wrap::kRepeat};
  const glm::vec3 q = cloudPosition(p, static_cast<float>(earthRadiusM_));
  float sum = 0.0f, clear = 0.0f;
  for (const CloudLayer& layer : layers_) sum += cloudExtinction(layer, placement, shape, detail, q, clear);
  return sum;
}

float CloudField::opticalDepth(glm::vec3 from, glm::vec3 direction, float enough, int only) const {
  const sampler2D placement{&noise_->placement, Wrap::kRepeat, Wrap::kRepeat};
  const sampler3D shape{&noise_->shape, Wrap::kRepeat}, detail{&noise_->detail, Wrap::kRepeat};
  const float radius = static_cast<float>(earthRadiusM_);
  double ground0 = 0.0, ground1 = 0.0, end = 600e3;
  if (crossings(from, direction, earthRadiusM_, 0.0, ground0, ground1) && ground0 > 0.0) end = ground0;

  float tau = 0.0f;
  for (std::size_t i = 0; i < layers_.size() && tau < enough; ++i) {
    if (only >= 0 && static_cast<int>(i) != only) continue;
    const CloudLayer& layer = layers_[i];
    double outer0, outer1, inner0, inner1;
    if (!crossings(from, direction, earthRadiusM_, layer.topM, outer0, outer1)) continue;
    // The ray is inside the shell on one or two stretches: before and behind the sphere of the base.
    double stretches[2][2] = {{std::max(outer0, 0.0), std::min(outer1, end)}, {0.0, 0.0}};
    if (crossings(from, direction, earthRadiusM_, layer.baseM, inner0, inner1)) {
      stretches[0][1] = std::min(std::max(inner0, 0.0), end);
      stretches[1][0] = std::max(inner1, 0.0);
      stretches[1][1] = std::min(outer1, end);
    }
    for (const auto& s : stretches) {
      float t = static_cast<float>(s[0]);
      const float stop = static_cast<float>(s[1]);
      const float fine = std::min(kShareOfStretch * (stop - t), kShareOfBlob * blobM(layer));
      while (t < stop && tau < enough) {
        const float step = std::min(std::max(fine, kShareOfDistance * t), stop - t);
        float clear = 0.0f;
        const glm::vec3 q = cloudPosition(from + direction * (t + 0.5f * step), radius);
        tau += step * cloudExtinction(layer, placement, shape, detail, q, clear);
        t += std::max(step, 0.7f * clear);
      }
    }
  }
  return tau;
}

}  // namespace welkin::field
