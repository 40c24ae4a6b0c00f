// SPDX-License-Identifier: Apache-2.0
// The clouds of a sky as a medium that light is traced through by null collisions: collisions and
// transmittances without bias, of exactly the density that field/cloud_field.h defines, with all its detail
// at any distance.
//
// E. R. Woodcock et al. 1965, "Techniques used in the GEM code for Monte Carlo neutronics calculations"
// (collisions); J. Novak, A. Selle and W. Jarosz 2014, "Residual Ratio Tracking for Estimating Attenuation in
// Participating Media" (transmittance). Majorants are local: majorant_grid.h.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "welkin/core/random.h"
#include "welkin/reference/cloud_density.h"
#include "welkin/reference/majorant_grid.h"
#include "welkin/reference/sphere.h"
#include "welkin/scene/rain_shafts.h"

namespace welkin::reference {

class CloudMedium {
 public:
  // field: outlives this. layers: indices of those that are traced; matter: of each layer of the field, those
  // that are not in it having droplets.
  using Matter = scene::CloudMatter;
  CloudMedium(const field::CloudField& field, const std::vector<int>& layers,
              const std::vector<Matter>& matter);

  struct Collision {
    double t = 0.0;  // along the ray
    Matter matter = Matter::kDroplets;
  };
  // Rays end at the ground, or at `end` before it.
  static constexpr double kToGround = std::numeric_limits<double>::infinity();

  // The first collision in [0, end), or none.
  std::optional<Collision> collide(const Ray& ray, double end, Random& random) const;

  // An estimate of the transmittance over [0, end), in [0, ...): its mean is the transmittance.
  double transmittance(const Ray& ray, double end, Random& random) const;

  // Extinction at a place, 1/m.
  double extinction(const glm::dvec3& p) const;

  // What those two are made of, for cloud_walks.h, which goes along many rays at once.

  // The stretches of [0, end) that are between the lowest base and the highest top: before and behind the
  // sphere of the base. Of no length, or less: none.
  using Stretches = std::array<std::array<double, 2>, 2>;
  Stretches stretches(const Ray& ray, double end) const;
  // So long a piece of a ray, from a on, as a line of cloud positions: over the curved ground they bend off
  // it by 0.16 m, which is within the grid's margin.
  static constexpr double kPieceM = 2000.0;
  CloudLine lineFrom(const Ray& ray, double a, float length) const;
  // What is left of a transmittance goes on with a chance below this share.
  static constexpr double kRouletteBelow = 0.1, kRouletteTo = 0.25;
  static constexpr double kMostControl = 1.5;  // of an optical depth, until it is looked at

  // Layers of ice, snow and rain, bit i for the field's layer i.
  struct Bits {
    std::uint32_t ice = 0, snow = 0, rain = 0;
  };
  Bits matters() const { return {ice_, snow_, rain_}; }
  // What all of some layers are made of; none: of several things.
  std::optional<Matter> onlyMatter(std::uint32_t layers) const {
    for (const auto& [bits, matter] :
         {std::pair(~(ice_ | snow_ | rain_), Matter::kDroplets), std::pair(ice_, Matter::kIce),
          std::pair(snow_, Matter::kSnow), std::pair(rain_, Matter::kRain)})
      if ((layers & ~bits) == 0) return matter;
    return std::nullopt;
  }
  const CloudDensity& density() const { return density_; }
  const MajorantGrid* grid() const { return grid_ ? &*grid_ : nullptr; }
  const Sphere& earth() const { return earth_; }

 private:
  struct Point {
    float extinction = 0.0f, ice = 0.0f, snow = 0.0f, rain = 0.0f;  // all, and what of it is each
  };
  using Bounds = MajorantGrid::Bounds;
  Point pointIn(unsigned layers, const glm::dvec3& p) const;

  // Calls f(bounds, layers, t0, t1) for the cells of the grid along [0, end) that may have cloud, until it
  // returns true.
  template <class F>
  void walk(const Ray& ray, double end, F&& f) const;

  CloudDensity density_;
  unsigned ice_ = 0, snow_ = 0, rain_ = 0;  // bit i for the field's layer i
  Sphere earth_;
  std::optional<MajorantGrid> grid_;  // none: no layers
};

}  // namespace welkin::reference
