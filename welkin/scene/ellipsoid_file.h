// SPDX-License-Identifier: Apache-2.0
// Ellipsoids of a cloud as TOML:
//
//   [[ellipsoid]]
//   centre_m = [0, 0, 400]
//   radii_m = [600, 450, 350]
//   rotation_deg = [0, 0, 30]
//
// Keys, units, ranges and defaults are those of the description in field/ellipsoid.h.
#pragma once

#include <string>
#include <vector>

#include "welkin/field/ellipsoid.h"

namespace welkin::scene {

// Throws IoError when the file cannot be read; ParseError with file:line:column for what a scene file would
// also refuse, and for a file without ellipsoids.
std::vector<field::Ellipsoid> readEllipsoids(const std::string& path);

}  // namespace welkin::scene
