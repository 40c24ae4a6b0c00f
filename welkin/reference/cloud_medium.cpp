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

double freeDepth(Random& random) {
  // The least number is half a step, so that the longest is 18.
  return static_cast<double>(-std::log((static_cast<float>(random.next() >> 40) + 0.5f) * 0x1p-24f));
}

}  // namespace

CloudMedium::CloudMedium(const field::CloudField& field, const std::vector<int>& layers,
                         const std::vector<Matter>& matter)
    : density_(field), earth_(field.earthRadiusM()) {
  for (std::size_t i = 0; i < matter.size(); ++i) {
    if (matter[i] == Matter::kIce) ice_ |= 1u << i;
    if (matter[i] == Matter::kSnow) snow_ |= 1u << i;
    if (matter[i] == Matter::kRain) rain_ |= 1u << i;
  }
  if (!layers.empty()) grid_.emplace(field, layers);
}

CloudMedium::Point CloudMedium::pointIn(unsigned layers, const glm::dvec3& p) const {
  const vec3 q = cloudPosition(vec3(p), static_cast<float>(earth_.radiusM()));
  Point point;
  for (unsigned left = layers; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    const float sigma = density_.extinction(static_cast<std::size_t>(i), q);
    point.extinction += sigma;
    if (ice_ >> i & 1) point.ice += sigma;
    if (snow_ >> i & 1) point.snow += sigma;
    if (rain_ >> i & 1) point.rain += sigma;
  }
  return point;
}

double CloudMedium::extinction(const glm::dvec3& p) const {
  if (!grid_) return 0.0;
  const vec3 q = cloudPosition(vec3(p), static_cast<float>(earth_.radiusM()));
  return pointIn(grid_->at(q).layers, p).extinction;
}

CloudMedium::Stretches CloudMedium::stretches(const Ray& ray, double end) const {
  Stretches s{};
  double near = 0.0, far = 0.0, innerNear = 0.0, innerFar = 0.0;
  if (!grid_ || !earth_.crossings(ray, grid_->highM(), near, far)) return s;
  s[0] = {std::max(near, 0.0), std::min(far, end)};
  if (earth_.rises(ray) && earth_.height(ray.from) > grid_->lowM())
    return s;  // the sphere of the base is behind
  if (earth_.crossings(ray, grid_->lowM(), innerNear, innerFar)) {
    s[0][1] = std::min(innerNear, end);
    if (earth_.toGround(ray, -1.0) < 0.0) s[1] = {std::max(innerFar, 0.0), std::min(far, end)};
  }
  return s;
}

CloudLine CloudMedium::lineFrom(const Ray& ray, double a, float length) const {
  const auto radius = static_cast<float>(earth_.radiusM());
  const vec3 q = cloudPosition(vec3(ray.at(a)), radius);
  return {q, (cloudPosition(vec3(ray.at(a + static_cast<double>(length))), radius) - q) / length};
}

template <class F>
void CloudMedium::walk(const Ray& ray, double end, F&& f) const {
  if (!grid_) return;
  for (const auto& stretch : stretches(ray, end))
    for (double a = stretch[0]; a < stretch[1]; a += kPieceM) {
      const auto length = static_cast<float>(std::min(kPieceM, stretch[1] - a));
      const CloudLine line = lineFrom(ray, a, length);
      if (grid_->walk(line, length, [&](const Bounds& bounds, unsigned there, float t0, float t1) {
            return f(bounds, there, a + static_cast<double>(t0), a + static_cast<double>(t1));
          }))
        return;
      if (MajorantGrid::isBeyond(line.from)) break;
    }
}

std::optional<CloudMedium::Collision> CloudMedium::collide(const Ray& ray, double end, Random& random) const {
  std::optional<Collision> collision;
  double depth = freeDepth(random);
  walk(ray, end, [&](const Bounds& bounds, unsigned layers, double t0, double t1) {
    const double majorant = bounds.majorant;
    const bool iceHere = (layers & ice_) != 0, snowHere = (layers & snow_) != 0,
               rainHere = (layers & rain_) != 0, dropletsHere = (layers & ~(ice_ | snow_ | rain_)) != 0,
               mixed = iceHere + snowHere + rainHere + dropletsHere > 1;
    for (;;) {
      const double left = (t1 - t0) * majorant;
      if (depth >= left) {
        depth -= left;
        return false;
      }
      t0 += depth / majorant;
      const double u = unit(random) * majorant;
      // Below the least of the extinction it need not be known.
      if (u < static_cast<double>(bounds.minorant) && !mixed) {
        collision = {t0, iceHere    ? Matter::kIce
                         : snowHere ? Matter::kSnow
                         : rainHere ? Matter::kRain
                                    : Matter::kDroplets};
        return true;
      }
      const Point point = pointIn(layers, ray.at(t0));
      if (u < static_cast<double>(point.extinction)) {
        const auto ice = static_cast<double>(point.ice), orSnow = ice + static_cast<double>(point.snow),
                   orRain = orSnow + static_cast<double>(point.rain);
        collision = {t0, u < ice      ? Matter::kIce
                         : u < orSnow ? Matter::kSnow
                         : u < orRain ? Matter::kRain
                                      : Matter::kDroplets};
        return true;
      }
      depth = freeDepth(random);
    }
  });
  return collision;
}

double CloudMedium::transmittance(const Ray& ray, double end, Random& random) const {
  double through = 1.0, control = 0.0;  // control: the optical depth of the minorants, not yet in `through`
  double depth = freeDepth(random);
  auto ends = [&] {
    if (through >= kRouletteBelow) return false;
    through = unit(random) * kRouletteTo < through ? kRouletteTo : 0.0;
    return through == 0.0;
  };
  walk(ray, end, [&](const Bounds& bounds, unsigned layers, double t0, double t1) {
    control += (t1 - t0) * static_cast<double>(bounds.minorant);
    if (control > kMostControl) {
      through *= std::exp(-control);
      control = 0.0;
      if (ends()) return true;
    }
    const double rest = static_cast<double>(bounds.majorant) - static_cast<double>(bounds.minorant);
    for (;;) {
      const double left = (t1 - t0) * rest;
      if (depth >= left) {
        depth -= left;
        return false;
      }
      t0 += depth / rest;
      depth = freeDepth(random);
      const double more =
          static_cast<double>(pointIn(layers, ray.at(t0)).extinction) - static_cast<double>(bounds.minorant);
      through *= std::clamp(1.0 - more / rest, 0.0, 1.0);
      if (ends()) return true;
    }
  });
  return through * std::exp(-control);
}

}  // namespace welkin::reference
