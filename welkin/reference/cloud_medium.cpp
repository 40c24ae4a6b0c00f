// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_medium.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "welkin/core/glsl.h"
#include "welkin/reference/directions.h"

namespace welkin::reference {
namespace {

using namespace welkin::glsl;
using field::CloudLayer;
#include "shaders/lib/clouds.glsl"

// Positions along so long a piece of a ray are taken to lie on a straight line of cloud positions: they bend
// off it by 0.16 m over the curved ground, which is within the grid's margin.
constexpr double kPieceM = 2000.0;
constexpr float kNudgeM = 2e-3f;  // over a brick's side
// What is left of a transmittance goes on with a chance below this share.
constexpr double kRouletteBelow = 0.1, kRouletteTo = 0.25;

double freeDepth(Random& random) {
  return -std::log1p(-unit(random));
}

}  // namespace

CloudMedium::CloudMedium(const field::CloudField& field, const std::vector<int>& layers,
                         std::vector<bool> ice)
    : field_(field), ice_(std::move(ice)), earth_(field.earthRadiusM()) {
  if (!layers.empty()) grid_.emplace(field, layers);
}

CloudMedium::Point CloudMedium::pointIn(const MajorantGrid::Brick& brick, const glm::dvec3& p) const {
  const vec3 q = cloudPosition(vec3(p), static_cast<float>(earth_.radiusM()));
  const sampler2D placement{&field_.noise().placement, Wrap::kRepeat, Wrap::kRepeat};
  const sampler3D shape{&field_.noise().shape, Wrap::kRepeat}, detail{&field_.noise().detail, Wrap::kRepeat};
  Point point;
  for (unsigned left = brick.layers; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    const CloudLayer& layer = field_.layers()[static_cast<std::size_t>(i)];
    if (q.z <= layer.baseM || q.z >= layer.topM) continue;
    float sigma = 0.0f;
    if (brick.full >> i & 1) {
      const float h = (q.z - layer.baseM) / (layer.topM - layer.baseM);
      sigma = cloudBodyExtinction(layer, h);
    } else {
      float clear = 0.0f;
      sigma = cloudExtinction(layer, placement, shape, detail, q, clear);
    }
    point.extinction += sigma;
    if (ice_[static_cast<std::size_t>(i)]) point.ice += sigma;
  }
  return point;
}

double CloudMedium::extinction(const glm::dvec3& p) const {
  if (!grid_) return 0.0;
  const vec3 q = cloudPosition(vec3(p), static_cast<float>(earth_.radiusM()));
  return pointIn(grid_->at(q), p).extinction;
}

template <class F>
void CloudMedium::walk(const Ray& ray, double end, F&& f) const {
  if (!grid_) return;
  double near = 0.0, far = 0.0, innerNear = 0.0, innerFar = 0.0;
  if (!earth_.crossings(ray, grid_->highM(), near, far)) return;
  // Inside the shell on one or two stretches: before and behind the sphere of the lowest base.
  double stretches[2][2] = {{std::max(near, 0.0), std::min(far, end)}, {0.0, 0.0}};
  if (earth_.crossings(ray, grid_->lowM(), innerNear, innerFar)) {
    stretches[0][1] = std::min(innerNear, end);
    stretches[1][0] = std::max(innerFar, 0.0);
    stretches[1][1] = std::min(far, end);
  }
  const auto radius = static_cast<float>(earth_.radiusM());
  for (const auto& stretch : stretches) {
    for (double a = stretch[0]; a < stretch[1]; a += kPieceM) {
      const auto length = static_cast<float>(std::min(kPieceM, stretch[1] - a));
      const vec3 q0 = cloudPosition(vec3(ray.at(a)), radius);
      const vec3 slope = (cloudPosition(vec3(ray.at(a + static_cast<double>(length))), radius) - q0) / length;
      if (std::max(std::abs(q0.x), std::abs(q0.y)) > MajorantGrid::kReachM) break;
      vec3 inverse;
      for (int k = 0; k < 3; ++k) inverse[k] = std::abs(slope[k]) > 1e-9f ? 1.0f / slope[k] : 0.0f;
      for (float t = 0.0f; t < length;) {
        const vec3 q = q0 + slope * (t + kNudgeM);
        const MajorantGrid::Brick brick = grid_->at(q);
        float out = length;
        for (int k = 0; k < 3; ++k) {
          if (inverse[k] == 0.0f) continue;
          const float side = inverse[k] > 0.0f ? brick.box.high[k] : brick.box.low[k];
          out = std::min(out, (side - q0[k]) * inverse[k]);
        }
        out = std::min(std::max(out, t + kNudgeM), length);
        if (brick.layers != 0 && f(brick, a + static_cast<double>(t), a + static_cast<double>(out))) return;
        t = out;
      }
    }
  }
}

template <class F>
void CloudMedium::track(const Ray& ray, double end, Random& random, F&& f) const {
  double depth = freeDepth(random);
  walk(ray, end, [&](const MajorantGrid::Brick& brick, double t0, double t1) {
    const double majorant = brick.majorant;
    for (;;) {
      const double step = depth / majorant;
      if (t0 + step >= t1) {
        depth -= (t1 - t0) * majorant;
        return false;
      }
      t0 += step;
      depth = freeDepth(random);
      if (f(t0, majorant, pointIn(brick, ray.at(t0)))) return true;
    }
  });
}

std::optional<CloudMedium::Collision> CloudMedium::collide(const Ray& ray, double end, Random& random) const {
  std::optional<Collision> collision;
  track(ray, end, random, [&](double t, double majorant, const Point& point) {
    const double u = unit(random) * majorant;
    if (u >= static_cast<double>(point.extinction)) return false;
    collision = {t, u < static_cast<double>(point.ice)};
    return true;
  });
  return collision;
}

double CloudMedium::transmittance(const Ray& ray, double end, Random& random) const {
  double through = 1.0;
  track(ray, end, random, [&](double, double majorant, const Point& point) {
    through *= std::max(1.0 - static_cast<double>(point.extinction) / majorant, 0.0);
    if (through >= kRouletteBelow) return false;
    through = unit(random) * kRouletteTo < through ? kRouletteTo : 0.0;
    return through == 0.0;
  });
  return through;
}

}  // namespace welkin::reference
