// SPDX-License-Identifier: Apache-2.0
// Which parts of a still need more sub-frames. Two sub-frames that agree about a tile are enough for it: clear sky, ground, the inside of an
// overcast. Edges and rough cloud get them all.
#pragma once

#include <vector>

#include "welkin/core/image.h"
#include "welkin/gpu/draw.h"

namespace welkin::render {

// Tiles (merged along rows) in which the sub-frames `first` and `both` - `first` differ by more than `tolerance`: the mean relative
// difference of luminance, or a quarter of the largest. `both` is the sum of the two sub-frames; top row first, RGBA. The tiles count from the
// bottom, as draws do.
std::vector<gpu::Tile> unfinishedTiles(const Image<float>& first, const Image<float>& both, float tolerance);

}  // namespace welkin::render
