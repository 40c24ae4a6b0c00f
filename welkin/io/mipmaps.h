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
  // `emit(level, z, slice)` is called for each slice of each level >= 1 as soon as it is known, in order of z
  // but for kRepeat, where the first slices of a volume come last. Levels interleave.
  using Emit = std::function<void(int level, int z, std::span<const std::byte> slice)>;
  MipChain(const TexelShape& top, MipFilter filter, MipEdges edges, Emit emit);
  ~MipChain();

  // The next slice of the full level.
  void addSlice(std::span<const std::byte> slice);
  // After the last one: emits what was waiting.
  void finish();

 private:
  class Level;
  std::unique_ptr<Level> first_;
};

}  // namespace welkin::io
