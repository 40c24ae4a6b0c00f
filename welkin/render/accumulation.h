// SPDX-License-Identifier: Apache-2.0
// Which parts of a still need more than one sub-frame, and the picture from their sums. Everything here looks
// at pixels beside each other; a picture's form says which of them are so in the sky, too.
#pragma once

#include <cstdint>

#include "welkin/core/image.h"
#include "welkin/scene/scene.h"

namespace welkin::render {

enum class Form {
  kPlane,     // as it lies there
  kAround,    // the right edge continues at the left one: equirectangular
  kSixFaces,  // side by side, each a picture of its own: cube maps
};
Form formOf(scene::Projection projection);

// The first sub-frame goes in two halves, the squares of a chessboard of blocks, four by four pixels: most of
// the second need not be drawn inside an overcast or a large cloud. Masks are 1 where pixels are to be drawn
// and 0 elsewhere, one channel, top row first.
Image<std::uint8_t> firstHalf(int width, int height, Form form = Form::kPlane);
// The blocks of the second half that those around them do not tell: all but those with blocks on all four
// sides that are not rough and where clouds hide what is behind them, and where four guesses of the luminance
// lie within twice `tolerance` of each other: lines through the blocks on two sides, curves through these and
// the next ones, both along either axis. half: what is drawn, RGBA with its weight in alpha, 0 elsewhere;
// hidden: the share of what is behind that clouds hide.
Image<std::uint8_t> secondHalf(const Image<float>& half, const Image<float>& hidden, float tolerance,
                               Form form = Form::kPlane);
// Gives the blocks that have not been drawn what those around them tell, with weight 1. Returns which they
// are, as a mask.
Image<std::uint8_t> fillBlocks(Image<float>& first, Form form = Form::kPlane);

// Pixels of the blocks, four by four, that one sub-frame does not settle: 1, the others 0, one channel, top
// row first. There luminance leaves the line between its neighbours by more than `tolerance` in the mean or
// four times that anywhere, relative to itself. Edges, fine forms and dither are rough; clear sky, haze and
// the inside of an overcast are not, whatever their gradient. `first`: the first sub-frame, RGBA with its
// weight in alpha, top row first.
Image<std::uint8_t> roughBlocks(const Image<float>& first, float tolerance, Form form = Form::kPlane);

// The same of the blocks that twice as many sub-frames have not settled either: where the means of the
// earlier and of the later half, over three by three pixels (resolve() takes out what is finer), differ from
// that of both by more than `tolerance` in the mean or twice that anywhere, relative to it; this is the
// standard error of the mean. before, sums: as `first`, with half of the sub-frames and with all; pixels that
// have got none in between are settled.
Image<std::uint8_t> unsettledBlocks(const Image<float>& before, const Image<float>& sums, float tolerance,
                                    Form form = Form::kPlane);

// The picture from sums of sub-frames: RGB means by the counts in alpha, and the dither that a few sub-frames
// leave taken out. The dither is such that any three by three pixels hold all its values, so the mean over
// five by five, which is taken, is nearly free of it; neighbours that differ from a pixel by more than three
// times `noise`, relative to their sum, are not of its surface and stay out, so that edges keep.
Image<float> resolve(const Image<float>& sums, float noise, Form form = Form::kPlane);

}  // namespace welkin::render
