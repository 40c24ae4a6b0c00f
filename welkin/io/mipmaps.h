// SPDX-License-Identifier: Apache-2.0
// Mipmaps computed while the texels stream by, with the memory of a few slices.
//
// Each level is half the one above, rounded down, at least 1. Channels are filtered apart from one another
// and as they are: no gamma, no weighting with alpha. Levels are computed from the floats of the level above,
// not from its rounded texels. The result does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "welkin/io/texels.h"

namespace welkin::io {

enum class MipFilter : std::uint8_t {
  kNone,  // no mipmaps
  kBox,   // each texel is the mean of what it covers, fractions of texels included: the mean of the whole is
          // kept, also for odd sizes
  kKaiser,  // sinc cut to 3 texels of the smaller level on either side by a Kaiser window (alpha 4): sharper
            // and with less aliasing than the box, but may overshoot
};
enum class MipEdges : std::uint8_t {
  kClamp,   // the border's texels go on outside
  kRepeat,  // tiles: the other side follows
};

// Sizes of all levels from the full one down to 1 x 1 x 1.
std::vector<TexelShape> mipShapes(const TexelShape& top);

// Weights of one axis: texel i of the smaller level is the sum of weights[j] * source[first + j]; `first + j`
// may lie outside [0, size) for kKaiser and is then clamped or wrapped. The weights of a texel sum to 1.
struct MipTap {
  int first = 0;
  std::vector<float> weights;
};
std::vector<MipTap> mipTaps(int size, MipFilter filter);

class MipChain {
 public:
  // Texels come and go in runs: a slice of a volume, a row of a picture, counted from 0. `emit(level, run,
  // texels)` is called for each run of each level >= 1 as soon as it is known; levels interleave. Runs of a
  // level come in order, but with kRepeat the first ones, which need the last texels, come last.
  using Emit = std::function<void(int level, int run, std::span<const std::byte> texels)>;
  // kBox or kKaiser.
  MipChain(const TexelShape& top, MipFilter filter, MipEdges edges, const Emit& emit);
  ~MipChain();

  // The next run of the full level. With the last one everything has been emitted.
  void add(std::span<const std::byte> run);

 private:
  class Level;
  TexelShape top_;
  int runs_ = 0;
  std::unique_ptr<Level> first_;  // null for a single texel
  std::vector<float> floats_;
};

}  // namespace welkin::io
