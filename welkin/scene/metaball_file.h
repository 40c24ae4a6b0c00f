// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs (field/metaballs.h) as JSON:
//
//   {"welkin": "metaballs",
//    "balls": [{"center_m": [x, y, z], "radius_m": R, "density": rho}, ...],
//    "relative_l2": 0.055, "rmse": 0.0047,
//    "levels": [{"balls": [...], "relative_l2": 0.19, "rmse": 0.016}, ...]}
//
// The cloud is `balls`, the finest level, and everything after it may be missing: who has read the balls has
// read the cloud. `levels` are coarser versions of the whole cloud, fewest balls first. Numbers are written
// so that they are read as the same numbers. Keys that are not known are passed over: others may add theirs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "welkin/field/metaballs.h"

namespace welkin::scene {

struct MetaballLevel {
  std::vector<field::Metaball> balls;
  std::optional<double> relativeL2, rmse;  // against the map that it was fitted to, where there was one
};

struct MetaballFile {
  std::vector<MetaballLevel> levels;  // at least one, the finest last
  const std::vector<field::Metaball>& balls() const { return levels.back().balls; }
};

// The text of the file.
std::string metaballText(const MetaballFile& file);

// `name` stands in messages. Throws ParseError with line and column for what is no JSON, and with the number
// of the ball for one that is not valid; for a file without balls, too.
MetaballFile parseMetaballs(const std::string& text, const std::string& name);

// Throws IoError when the file cannot be read, and what parseMetaballs() throws.
MetaballFile readMetaballs(const std::string& path);

}  // namespace welkin::scene
