// SPDX-License-Identifier: Apache-2.0
// Which parts of a still need more sub-frames. Two sub-frames that agree about a tile are enough for it:
// clear sky, ground, the inside of an overcast. Edges and rough cloud get them all.
#pragma once

#include <vector>

#include "welkin/core/image.h"
#include "welkin/gpu/draw.h"

namespace welkin::render {

// Tiles (merged along rows) in which the sub-frames `first` and `both` - `first` differ by more than
// `tolerance`: the mean relative difference of luminance, or a quarter of the largest. `both` is the sum of
// the two sub-frames; top row first, RGBA. The tiles count from the bottom, as draws do.
std::vector<gpu::Tile> unfinishedTiles(const Image<float>& first, const Image<float>& both, float tolerance);

// The picture from sums of sub-frames: RGB means by the counts in alpha, and the dither that a few sub-frames
// leave taken out. The dither is such that any three by three pixels hold all its values, so the mean over
// these is free of it; neighbours that differ from a pixel by more than three times `noise`, relative to
// their sum, are not of its surface and stay out, so that edges keep.
Image<float> resolve(const Image<float>& sums, float noise);

}  // namespace welkin::render
