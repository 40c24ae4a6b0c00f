// SPDX-License-Identifier: Apache-2.0
// The blocks of a fill, compiled for every instruction set and chosen at run time.
#include "welkin/noise/fill.h"

#include <cmath>

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/noise/fill.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/highway.h>

#include "welkin/noise/value_rows-inl.h"
#if HWY_TARGET != HWY_SCALAR
#include "welkin/noise/cell_tiles-inl.h"
#include "welkin/noise/distort_rows-inl.h"
#include "welkin/noise/gradient_rows-inl.h"
#include "welkin/noise/store-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

// A processor without vectors gets the point function, but for value noise, whose bits no vectors change.
void fillBlock(const FillJob& job, const Block& b, Scratch& scratch) {
  scratch.reset();
  if (job.params->kind == Kind::kValue)
    fillValueBlock(job, b, scratch);
  else
    fillPointwise(job, b);
}

void makeCorners(const double* inside, int n, bool derivative, const CornerArrays& out) {
  for (int i = 0; i < n; ++i) {
    const double t = inside[i], high = fade(t), slope = fadeSlope(t);
    const auto put = [i](double v, float* to) {
      to[i] = std::abs(v) < CornerArrays::kLeast ? 0.0f : static_cast<float>(v);
    };
    put(derivative ? -slope : 1.0 - high, out.lowWeight);
    put(derivative ? 1.0 - high - slope * t : (1.0 - high) * t, out.lowReach);
    put(derivative ? slope : high, out.highWeight);
    put(derivative ? high + slope * (t - 1.0) : high * (t - 1.0), out.highReach);
  }
}

void makeHashes(std::uint32_t key, const std::uint32_t* index, int n, std::uint32_t* out) {
  for (int i = 0; i < n; ++i) out[i] = axisHash(key, index[i]);
}

#else

// Room for a chunk of rows.
inline float* takeChunk(const FillJob& job, Scratch& scratch) {
  return scratch.take<float>(static_cast<std::size_t>(job.gradients.chunk) * job.gradients.strip);
}

// Calls each(z, y, rows) for the chunks of a block, which begins with one, after `sums` have been filled.
template <class Each>
HWY_INLINE void forChunks(const FillJob& job, const Block& b, Scratch& scratch, float* const* sums,
                          const Each& each) {
  GradientRows rows(job.gradients, scratch, b.x, b.width);
  for (int z = b.z; z < b.z + b.slices; ++z) {
    rows.beginSlices(z, 1);
    for (int y = b.y; y < b.y + b.rows;) {
      const int count = rows.fillChunk(y, b.y + b.rows - y, sums);
      each(z, y, count);
      y += count;
    }
  }
}

// One sum of gradient noise, stored as it is made.
template <class Sink>
void fillSink(const FillJob& job, const Block& b, Scratch& scratch) {
  GradientRows rows(job.gradients, scratch, b.x, b.width);
  for (int z = b.z; z < b.z + b.slices;) {
    const int count = HWY_MIN(job.gradients.togetherFrom(z), b.z + b.slices - z);
    rows.beginSlices(z, count);
    for (int y = b.y; y < b.y + b.rows;)
      y += rows.fillChunkInto(y, b.y + b.rows - y,
                              [&](int slice, int) HWY_ATTR { return Sink(job, b.x, y, z + slice, b.width); });
    z += count;
  }
}

// Sums of gradient noise, each a channel.
void fillSums(const FillJob& job, const Block& b, Scratch& scratch) {
  if (job.direct())
    return job.format == Format::kFloat ? fillSink<FloatSink>(job, b, scratch)
                                        : fillSink<ByteSink>(job, b, scratch);
  float* channel[4];
  for (int c = 0; c < job.channels; ++c) channel[c] = takeChunk(job, scratch);
  forChunks(job, b, scratch, channel, [&](int z, int y, int rows) HWY_ATTR {
    storeRows(job, channel, job.gradients.strip, b.x, y, z, b.width, rows);
  });
}

void fillDistorted(const FillJob& job, const Block& b, Scratch& scratch) {
  const int sums = job.gradients.sums;
  float** shifts = scratch.take<float*>(static_cast<std::size_t>(sums));
  const float** shift = scratch.take<const float*>(static_cast<std::size_t>(sums));
  for (int s = 0; s < sums; ++s) shifts[s] = takeChunk(job, scratch);
  float* out = takeChunk(job, scratch);
  forChunks(job, b, scratch, shifts, [&](int z, int y, int rows) HWY_ATTR {
    for (int r = 0; r < rows; ++r) {
      for (int s = 0; s < sums; ++s) shift[s] = shifts[s] + std::ptrdiff_t{r} * job.gradients.strip;
      distortRow(job, shift, b.x, y + r, z, b.width, out + std::ptrdiff_t{r} * job.gradients.strip);
    }
    storeRows(job, &out, job.gradients.strip, b.x, y, z, b.width, rows);
  });
}

// Perlin-Worley's channels of a row, from gradient noise (overwritten by channel 0) and four rows of cells.
HWY_INLINE void mixRow(int width, const float* const* cells, float* const* channel) {
  const hn::ScalableTag<float> d;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto a = hn::Set(d, kCoarse[0]), e = hn::Set(d, kCoarse[1]), f = hn::Set(d, kCoarse[2]);
  for (int i = 0; i < width; i += static_cast<int>(hn::Lanes(d))) {
    const auto w0 = hn::Clamp(hn::Sub(one, hn::LoadU(d, cells[0] + i)), zero, one);
    const auto w1 = hn::Clamp(hn::Sub(one, hn::LoadU(d, cells[1] + i)), zero, one);
    const auto w2 = hn::Clamp(hn::Sub(one, hn::LoadU(d, cells[2] + i)), zero, one);
    const auto w3 = hn::Clamp(hn::Sub(one, hn::LoadU(d, cells[3] + i)), zero, one);
    const auto n = hn::Clamp(hn::Load(d, channel[0] + i), zero, one);
    const auto middle = hn::MulAdd(f, w3, hn::MulAdd(e, w2, hn::Mul(a, w1)));
    hn::Store(hn::MulAdd(n, hn::Sub(one, middle), middle), d, channel[0] + i);
    hn::Store(hn::MulAdd(f, w2, hn::MulAdd(e, w1, hn::Mul(a, w0))), d, channel[1] + i);
    hn::Store(middle, d, channel[2] + i);
    hn::Store(hn::MulAdd(hn::Set(d, kFine[1]), w3, hn::Mul(hn::Set(d, kFine[0]), w2)), d, channel[3] + i);
  }
}

// One octave of cells as floats, over whole tiles.
void fillCellFloats(const FillJob& job, const Block& b, const Block& tiles, Scratch& scratch) {
  const glm::ivec3& size = job.box.size;
  float* out = static_cast<float*>(job.out) + (static_cast<std::size_t>(b.z) * size.y + b.y) * size.x + b.x;
  const bool clamps = job.low > -hwy::HighestValue<float>() || job.high < hwy::HighestValue<float>();
  CellTiles(job.cells[0], tiles, scratch)
      .fill(job.params->feature, {out, size.x, static_cast<std::ptrdiff_t>(size.x) * size.y,
                                  job.cells[0].weight, job.bias, false, clamps, job.low, job.high});
}

// Blocks of cells lie at multiples of the tiles; what of them is in the box is stored.
void fillCells(const FillJob& job, const Block& b, Scratch& scratch) {
  const Block tiles = job.tilesOf(b);
  const bool mixed = job.params->kind == Kind::kPerlinWorley;
  const bool whole = tiles.width == b.width && tiles.rows == b.rows && tiles.slices == b.slices;
  if (whole && !mixed && job.cellTerms == 1 && job.format == Format::kFloat)
    return fillCellFloats(job, b, tiles, scratch);
  const int stride = tiles.width + 16;  // rows not all in the same sets of the cache
  const std::size_t samples = static_cast<std::size_t>(stride) * tiles.rows * tiles.slices;
  float* values[4] = {};
  for (int c = 0; c < (mixed ? 4 : 1); ++c) values[c] = scratch.take<float>(samples + kPad);
  for (int t = 0; t < job.cellTerms; ++t) {
    const bool first = mixed || t == 0;
    CellTiles(job.cells[t], tiles, scratch)
        .fill(mixed ? Feature::kF1 : job.params->feature,
              {values[mixed ? t : 0], stride, std::ptrdiff_t{stride} * tiles.rows, job.cells[t].weight,
               first ? job.bias : 0.0f, !first, false, 0.0f, 0.0f});
  }
  const auto rowOf = [&](float* v, int y, int z) HWY_ATTR {
    return v +
           (static_cast<std::ptrdiff_t>(z + job.lead[2] - tiles.z) * tiles.rows + y + job.lead[1] - tiles.y) *
               stride +
           b.x + job.lead[0] - tiles.x;
  };
  if (!mixed) {
    for (int z = b.z; z < b.z + b.slices; ++z) {
      const float* row = rowOf(values[0], b.y, z);
      storeRows(job, &row, stride, b.x, b.y, z, b.width, b.rows);
    }
    return;
  }
  float* channel[4];
  for (float*& c : channel) c = takeChunk(job, scratch);
  forChunks(job, b, scratch, channel, [&](int z, int y, int rows) HWY_ATTR {
    for (int r = 0; r < rows; ++r) {
      const float* cells[4];
      float* to[4];
      for (int c = 0; c < 4; ++c) {
        cells[c] = rowOf(values[c], y + r, z);
        to[c] = channel[c] + std::ptrdiff_t{r} * job.gradients.strip;
      }
      mixRow(b.width, cells, to);
    }
    storeRows(job, channel, job.gradients.strip, b.x, y, z, b.width, rows);
  });
}

void makeCorners(const double* inside, int n, bool derivative, const CornerArrays& out) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> df;
  const auto one = hn::Set(d, 1.0);
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(d))) {
    const auto t = hn::LoadU(d, inside + i), u = hn::Sub(t, one);
    // As fade() and fadeSlope(), nothing fused.
    auto high = hn::Sub(hn::Mul(t, hn::Set(d, 6.0)), hn::Set(d, 15.0));
    high = hn::Mul(hn::Mul(t, hn::Mul(t, t)), hn::Add(hn::Mul(t, high), hn::Set(d, 10.0)));
    auto low = hn::Sub(one, high);
    auto lowReach = hn::Mul(low, t), highReach = hn::Mul(high, u);
    if (derivative) {
      const auto slope = hn::Mul(hn::Set(d, 30.0), hn::Mul(hn::Mul(t, t), hn::Mul(u, u)));
      lowReach = hn::Sub(low, hn::Mul(slope, t));
      highReach = hn::Add(high, hn::Mul(slope, u));
      high = slope;
      low = hn::Neg(slope);
    }
    const auto put = [&](hn::Vec<decltype(d)> v, float* to) HWY_ATTR {
      const auto little = hn::Lt(hn::Abs(v), hn::Set(d, CornerArrays::kLeast));
      hn::StoreU(hn::DemoteTo(df, hn::IfThenZeroElse(little, v)), df, to + i);
    };
    put(low, out.lowWeight);
    put(lowReach, out.lowReach);
    put(high, out.highWeight);
    put(highReach, out.highReach);
  }
}

void makeHashes(std::uint32_t key, const std::uint32_t* index, int n, std::uint32_t* out) {
  const Words du;
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(du))) {
    const auto spread = hn::Mul(hn::LoadU(du, index + i), hn::Set(du, kHashStep));
    hn::StoreU(mixedWords(hn::Add(spread, hn::Set(du, key))), du, out + i);
  }
}

void fillBlock(const FillJob& job, const Block& b, Scratch& scratch) {
  scratch.reset();
  switch (job.params->kind) {
    case Kind::kPerlin:
    case Kind::kCurl:
      fillSums(job, b, scratch);
      break;
    case Kind::kDistorted:
      fillDistorted(job, b, scratch);
      break;
    case Kind::kCellular:
    case Kind::kPerlinWorley:
      fillCells(job, b, scratch);
      break;
    case Kind::kValue:
      fillValueBlock(job, b, scratch);
      break;
  }
}

#endif  // vectors

void addValues(const ValueTables& octave, const glm::ivec3& size, float* out, Scratch& scratch) {
  addValuesTo(octave, size, out, scratch);
}

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace welkin::noise {

HWY_EXPORT(fillBlock);
HWY_EXPORT(makeCorners);
HWY_EXPORT(makeHashes);
HWY_EXPORT(addValues);

void fillBlock(const FillJob& job, const Block& block, Scratch& scratch) {
  HWY_DYNAMIC_DISPATCH(fillBlock)(job, block, scratch);
}

void makeCorners(const double* inside, int n, bool derivative, const CornerArrays& out) {
  HWY_DYNAMIC_DISPATCH(makeCorners)(inside, n, derivative, out);
}

void makeHashes(std::uint32_t key, const std::uint32_t* index, int n, std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(makeHashes)(key, index, n, out);
}

void addValues(const ValueTables& octave, const glm::ivec3& size, float* out, Scratch& scratch) {
  HWY_DYNAMIC_DISPATCH(addValues)(octave, size, out, scratch);
}

}  // namespace welkin::noise

#endif
