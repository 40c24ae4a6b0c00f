// SPDX-License-Identifier: Apache-2.0
// A tower of cumulus by rule: a few bubbles rise over a flat base, the middle one highest; on each, smaller
// ones grow outwards and upwards, and smaller ones on those (after A. Bouthors and F. Neyret 2004, "Modeling
// Clouds Shape", whose hierarchy of particles this follows).
#pragma once

#include <vector>

#include "welkin/field/cloud_map.h"
#include "welkin/field/ellipsoid.h"

namespace welkin::field {

struct CumulusParams {
  std::int64_t seed = 0;
  double widthM = 1200.0;   // of the whole, along x and y
  double heightM = 1000.0;  // of the whole, above the base
  std::int64_t bubbles = 5;
  std::int64_t generations = 3;  // 1: the first bubbles alone
  std::int64_t children = 9;     // tried on each bubble
  double ratio = 0.5;            // a child's radius, of its parent's
  double lean = 0.0;             // downwind (+x) shift of the top, of the height
};
void describe(CumulusParams& p, ParamVisitor& v);

// The same parameters give the same ellipsoids everywhere. Their union spans exactly widthM along x and y and
// reaches exactly heightM; parts of it lie below the base, where the map is to cut it
// (CloudMapParams::baseM).
std::vector<Ellipsoid> cumulusTower(const CumulusParams& params);

// A map for that tower: a box that holds it with a margin of 5 %, and noise that frays its bubbles without
// cutting veins through them.
CloudMapParams cumulusMap(const CumulusParams& params, double voxelM);

// The box of voxels, its base at 0, that holds the ellipsoids' parts above it with a margin of 5 %.
void fitBox(CloudMapParams& map, std::span<const Ellipsoid> ellipsoids);

}  // namespace welkin::field
