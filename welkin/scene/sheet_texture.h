// SPDX-License-Identifier: Apache-2.0
// The pattern of a thin layer, from a file of texels or generated.
//
// A file is a picture for planes, a volume for domes (io/texel_file.h has the formats). The pattern is
// its one value; of several channels it is alpha, or the mean of red, green and blue where there is no alpha
// or the alpha is the same everywhere. Values are taken as they stand, without any transfer function, clamped
// to [0, 1]. The file should tile; its first row is the southernmost, its first slice the lowest. One that is
// not square is stretched over the tile.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "welkin/core/image.h"
#include "welkin/scene/sheet.h"

namespace welkin::scene {

struct PatternTexels {
  Image<float> flat;     // of planes, or
  Volume<float> volume;  // of domes
  bool fromFile = false;
  std::string warning;  // why the sheet's file was not used, naming it; empty: it was, or there is none

  std::span<const float> values() const { return flat.data.empty() ? volume.data : flat.data; }
};

// From the sheet's file; where it has none, or one that cannot be used, generated for the seed.
PatternTexels patternOf(const Sheet& sheet, std::uint64_t seed);

// The most texels a side that a file may have.
inline constexpr int kMaxPictureSide = 8192, kMaxVolumeSide = 512;

}  // namespace welkin::scene
