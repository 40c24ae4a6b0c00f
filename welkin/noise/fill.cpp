// SPDX-License-Identifier: Apache-2.0
// The blocks of a fill, compiled for every instruction set and chosen at run time.
#include "welkin/noise/fill.h"

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/noise/fill.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "welkin/noise/cell_tiles-inl.h"
#include "welkin/noise/distort_rows-inl.h"
#include "welkin/noise/gradient_rows-inl.h"
#include "welkin/noise/store-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

// A processor without vectors gets the point function.
void fillBlock(const FillJob& job, const Block& b, Scratch&) {
  fillPointwise(job, b);
}

#else

// Sums of gradient noise, each a channel.
void fillSums(const FillJob& job, const Block& b, Scratch& scratch) {
  GradientRows rows(job.gradients, scratch, b.x, b.width);
  float* channel[4];
  for (int c = 0; c < job.channels; ++c) channel[c] = scratch.take<float>(kStrip);
  for (int z = b.z; z < b.z + b.slices; ++z) {
    rows.beginSlice(z);
    for (int y = b.y; y < b.y + b.rows; ++y) {
      rows.row(y, channel);
      storeRow(job, channel, b.x, y, z, b.width);
    }
  }
}

void fillDistorted(const FillJob& job, const Block& b, Scratch& scratch) {
  GradientRows rows(job.gradients, scratch, b.x, b.width);
  const int sums = job.gradients.sums;
  float** shifts = scratch.take<float*>(static_cast<std::size_t>(sums));
  for (int s = 0; s < sums; ++s) shifts[s] = scratch.take<float>(kStrip);
  float* out = scratch.take<float>(kStrip);
  for (int z = b.z; z < b.z + b.slices; ++z) {
    rows.beginSlice(z);
    for (int y = b.y; y < b.y + b.rows; ++y) {
      rows.row(y, shifts);
      distortRow(job, shifts, b.x, y, z, b.width, out);
      storeRow(job, &out, b.x, y, z, b.width);
    }
  }
}

// Blocks of cells lie at multiples of the tiles; what of them is in the box is stored.
void fillCells(const FillJob& job, const Block& b, Scratch& scratch) {
  const Block tiles = job.tilesOf(b);
  const int stride = tiles.width;
  const std::size_t samples = static_cast<std::size_t>(stride) * tiles.rows * tiles.slices;
  const bool separate = job.params->kind == Kind::kPerlinWorley;
  float* values[4] = {};
  for (int c = 0; c < (separate ? 4 : 1); ++c) values[c] = scratch.take<float>(samples + kPad);
  for (int t = 0; t < job.cellTerms; ++t) {
    const bool first = separate || t == 0;
    CellTiles(job.cells[t], tiles, scratch)
        .fill(separate ? Feature::kF1 : job.params->feature, job.cells[t].weight, first ? job.bias : 0.0f,
              !first, values[separate ? t : 0], stride);
  }
  const auto rowOf = [&](float* v, int y, int z) HWY_ATTR {
    return v +
           (static_cast<std::ptrdiff_t>(z - tiles.z + job.lead[2]) * tiles.rows +
            (y - tiles.y + job.lead[1])) *
               stride +
           (b.x - tiles.x + job.lead[0]);
  };
  if (!separate) {
    for (int z = b.z; z < b.z + b.slices; ++z)
      for (int y = b.y; y < b.y + b.rows; ++y) {
        const float* row = rowOf(values[0], y, z);
        storeRow(job, &row, b.x, y, z, b.width);
      }
    return;
  }

  const hn::ScalableTag<float> d;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  GradientRows rows(job.gradients, scratch, b.x, b.width);
  float* gradient = scratch.take<float>(kStrip);
  float* channel[4];
  for (float*& c : channel) c = scratch.take<float>(kStrip);
  for (int z = b.z; z < b.z + b.slices; ++z) {
    rows.beginSlice(z);
    for (int y = b.y; y < b.y + b.rows; ++y) {
      rows.row(y, &gradient);
      const float* cells[4];
      for (int c = 0; c < 4; ++c) cells[c] = rowOf(values[c], y, z);
      for (int i = 0; i < b.width; i += static_cast<int>(hn::Lanes(d))) {
        const auto n = hn::Clamp(hn::Load(d, gradient + i), zero, one);
        hn::Vec<hn::ScalableTag<float> > w[4] = {zero, zero, zero, zero};
        for (int c = 0; c < 4; ++c) w[c] = hn::Clamp(hn::Sub(one, hn::LoadU(d, cells[c] + i)), zero, one);
        const auto sum = [&](int from, float a, float e, float f) HWY_ATTR {
          auto s = hn::Mul(hn::Set(d, a), w[from]);
          s = hn::MulAdd(hn::Set(d, e), w[from + 1], s);
          return f == 0.0f ? s : hn::MulAdd(hn::Set(d, f), w[from + 2], s);
        };
        const auto middle = sum(1, kCoarse[0], kCoarse[1], kCoarse[2]);
        hn::Store(hn::MulAdd(n, hn::Sub(one, middle), middle), d, channel[0] + i);
        hn::Store(sum(0, kCoarse[0], kCoarse[1], kCoarse[2]), d, channel[1] + i);
        hn::Store(middle, d, channel[2] + i);
        hn::Store(sum(2, kFine[0], kFine[1], 0.0f), d, channel[3] + i);
      }
      storeRow(job, channel, b.x, y, z, b.width);
    }
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
      break;
  }
  if (job.stream) hwy::FlushStream();
}

#endif  // vectors

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace welkin::noise {

HWY_EXPORT(fillBlock);

void fillBlock(const FillJob& job, const Block& block, Scratch& scratch) {
  HWY_DYNAMIC_DISPATCH(fillBlock)(job, block, scratch);
}

}  // namespace welkin::noise

#endif
