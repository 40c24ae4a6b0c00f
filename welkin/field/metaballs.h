// SPDX-License-Identifier: Apache-2.0
// Metaballs: a cloud as a sum of balls, density(x) = sum rho_i f(|x - c_i| / R_i), with the function of
// G. Wyvill, C. McPheeters and B. Wyvill 1986, "Data Structure for Soft Objects":
//
//   f(a) = 1 - 22/9 a^2 + 17/9 a^4 - 4/9 a^6 for a < 1, otherwise 0
//
// f is 1 at the centre, 1/2 at a = 1/2, and 0 with slope 0 at the surface; its integral over a ball of radius
// R is (736 pi / 2835) R^3. (P. Man 2006, "Generating and Real-Time Rendering of Clouds", formula 12, has
// lost a sign and divides by a constant that is no integral over the ball.)
//
// Frame: metres, that of the map that the balls came from (cloud_map.h), x east, y north, z up. Densities are
// in the map's unit and may be negative: the sum may then fall below 0 somewhere. Nothing here clamps it; who
// needs an extinction takes max(density, 0).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/image.h"
#include "welkin/field/ellipsoid.h"

namespace welkin::field {

struct Metaball {
  glm::dvec3 centreM{0.0};
  double radiusM = 1.0;  // > 0
  double density = 0.0;  // at the centre, of this ball alone
  bool operator==(const Metaball&) const = default;
};

// f as a function of a^2 >= 0.
constexpr double wyvillOfSquare(double s) {
  return s < 1.0 ? (1.0 - s) * (1.0 - s) * (1.0 - 4.0 / 9.0 * s) : 0.0;
}
constexpr double wyvill(double a) {
  return wyvillOfSquare(a * a);
}
// The integral of f over the unit ball, 4 pi int f(a) a^2 da.
constexpr double kWyvillIntegral = 736.0 * std::numbers::pi / 2835.0;

// The integral of the field over all space: density times m^3.
double integralOf(std::span<const Metaball> balls);
// The middle one of their radii; there must be some.
double medianRadiusOf(std::span<const Metaball> balls);

// The integral of a ball's density along a ray from a point in a unit direction, in closed form.
double columnAlong(const Metaball& ball, const glm::dvec3& from, const glm::dvec3& direction);

// The box around all of them; both corners 0 if there are none.
Box boundsOf(std::span<const Metaball> balls);

// The field at any point, from bins of balls: some 100 ns a point for 10,000 balls. Immutable, so any number
// of threads may ask.
class MetaballField {
 public:
  MetaballField() = default;
  // Throws ParameterError for a ball that is not finite or whose radius is not positive.
  explicit MetaballField(std::vector<Metaball> balls);

  double operator()(const glm::dvec3& p) const;

  const std::vector<Metaball>& balls() const { return balls_; }
  const Box& bounds() const { return bounds_; }

 private:
  glm::ivec3 binOf(const glm::dvec3& p) const;

  std::vector<Metaball> balls_;
  Box bounds_{glm::dvec3(0.0), glm::dvec3(0.0)};
  glm::ivec3 bins_{0};
  glm::dvec3 perMetre_{0.0};           // bins
  std::vector<std::uint32_t> begins_;  // of each bin's part of members_
  std::vector<std::uint32_t> members_;
};

// Throws ParameterError that names the first ball whose centre, radius or density is not finite or beyond
// what floats can reckon with (1e15 m, densities of 1e30), or whose radius is not positive.
void validate(std::span<const Metaball> balls);

// Where the voxels of a volume stand: as io::TexelNotes says it of files.
struct VoxelFrame {
  int nx = 0, ny = 0, nz = 0;
  glm::dvec3 voxelSizeM{1.0};
  glm::dvec3 firstVoxelM{0.0};  // centre of voxel (0, 0, 0)
};

// The field at the voxels' centres. Costs as much as the balls have voxels; the same bytes in any number of
// threads. Throws ParameterError as validate() does.
Volume<float> rasterise(std::span<const Metaball> balls, const VoxelFrame& frame);

}  // namespace welkin::field
