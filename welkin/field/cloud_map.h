// SPDX-License-Identifier: Apache-2.0
// Cloud maps: noise in a union of ellipsoids on a grid of voxels. P. Man 2006, "Generating and Real-Time
// Rendering of Clouds":
//
//   density = dynamics * Q * noise where Q * noise >= threshold, otherwise 0
//
// with Q = 1 - |r|^2 of the ellipsoid equation, 1 at a centre and 0 on a surface; several ellipsoids unite as
// 1 - (1 - Q_1) (1 - Q_2) ..., which is 0 on the surface of the union and close to 1 where they overlap.
// (The paper's formula 10 drops the noise, and its formula 8 has the sign turned round.) The
// noise is the paper's formula 1: octaves of value noise summed, made positive.
//
// Deterministic: the same parameters give the same bits in any number of threads.
#pragma once

#include <functional>
#include <span>

#include "welkin/core/image.h"
#include "welkin/core/params.h"
#include "welkin/field/ellipsoid.h"
#include "welkin/noise/value.h"

namespace welkin::field {

enum class MapNoiseKind { kValue, kPerlin };
enum class MapFold {
  kAbsolute,  // |v|, the paper's: veins where the noise changes its sign
  kShifted,   // 1/2 + v/6 in deviations of v, clamped to [0, 1]: no veins
};

struct MapNoise {
  MapNoiseKind kind = MapNoiseKind::kValue;
  std::int64_t octaves = 4;  // 0: no noise, 1 everywhere
  double persistence = 0.5;  // amplitude of an octave, of the one before; the first has 1
  double cellVoxels = 12.0;  // size of the first octave's lattice cells; each further one has half
  noise::Interpolation interpolation = noise::Interpolation::kCosine;  // of value noise
  bool smooth = true;                                                  // of value noise
  MapFold fold = MapFold::kAbsolute;
  std::int64_t seed = 0;  // 0: for value noise the source's hash
};
void describe(MapNoise& n, ParamVisitor& v);

// The defaults with one ellipsoid of centredEllipsoid() are the paper's example (Z = 4, s = 0.5): about
// 11,800 voxels of cloud.
struct CloudMapParams {
  std::int64_t nx = 48, ny = 36, nz = 24;
  double voxelM = 20.0;  // edge of a voxel, a cube
  double threshold = 0.03;
  double dynamics = 1.0;
  std::optional<double> baseM = {};  // no cloud below, above the bottom of the box
  MapNoise noise = {};
};
void describe(CloudMapParams& p, ParamVisitor& v);

// Throws ParameterError: sizes, and more than 2^31 voxels.
void validate(const CloudMapParams& p);

// The ellipsoid in the middle of the box that takes 95 % of its edges, so that no cloud touches the sides.
Ellipsoid centredEllipsoid(const CloudMapParams& p);

// One channel, x east fastest, then y north, then z up. The box stands with the middle of its base at the
// ellipsoids' origin; the noise's lattice begins at its least corner; samples are at the voxels' centres.
// progress: called from the calling thread with the fraction done; may throw to stop.
// Throws ParameterError if no voxel has any cloud, saying what threshold some would reach.
Volume<float> cloudMap(const CloudMapParams& p, std::span<const Ellipsoid> ellipsoids,
                       const std::function<void(double)>& progress = {});

// Centre of voxel (0, 0, 0), metres.
glm::dvec3 firstVoxelM(const CloudMapParams& p);

}  // namespace welkin::field

namespace welkin {
template <>
inline constexpr auto kEnumNames<field::MapNoiseKind> = std::to_array<std::string_view>({"value", "perlin"});
template <>
inline constexpr auto kEnumNames<field::MapFold> = std::to_array<std::string_view>({"absolute", "shifted"});
}  // namespace welkin
