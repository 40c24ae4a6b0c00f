// SPDX-License-Identifier: Apache-2.0
// A ball over a grid, row by row, a vector of voxels at a time. Compiled for every instruction set; for
// sources of field/ and fit/ that are, too.
//
// Wyvill's function of s = a^2 is 1 - 22/9 s + 17/9 s^2 - 4/9 s^3 = t^2 (1 - 4/9 s) with t = 1 - s, and its
// derivative by s -t (22/9 - 12/9 s): with t = max(1 - s, 0) both vanish outside without a branch.
#if defined(WELKIN_FIELD_METABALL_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_FIELD_METABALL_ROWS_INL_H_
#undef WELKIN_FIELD_METABALL_ROWS_INL_H_
#else
#define WELKIN_FIELD_METABALL_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "welkin/field/metaball_grid.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::field::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RowLanes = hn::CappedTag<float, kRowPadding>;
using RowFloats = hn::Vec<RowLanes>;

HWY_INLINE RowFloats insideOf(RowLanes d, RowFloats s) {
  return hn::Max(hn::Sub(hn::Set(d, 1.0f), s), hn::Zero(d));
}

HWY_INLINE RowFloats kernelOf(RowLanes d, RowFloats s, RowFloats t) {
  return hn::Mul(hn::Mul(t, t), hn::NegMulAdd(hn::Set(d, 4.0f / 9.0f), s, hn::Set(d, 1.0f)));
}

HWY_INLINE RowFloats kernelSlopeOf(RowLanes d, RowFloats s, RowFloats t) {
  return hn::Mul(t, hn::MulSub(hn::Set(d, 12.0f / 9.0f), s, hn::Set(d, 22.0f / 9.0f)));
}

HWY_INLINE double sumOf(RowLanes d, RowFloats v) {
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v)));
}

// For each row that the ball crosses beginRow(dy, dz), the offsets of the row from the centre; along it
// each(at, dx, s) with the index of the vector's first voxel; endSlice() after the rows of a slice.
template <class Row, class Each, class Slice>
HWY_INLINE void overBall(const BallGrid& grid, const GridBall& ball, SliceRange slices, const Row& beginRow,
                         const Each& each, const Slice& endSlice) {
  const RowLanes d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const glm::dvec3 centre = ball.centre - grid.first;
  const double r2 = ball.radius * ball.radius;
  const auto stepX = static_cast<float>(grid.step.x);
  const RowFloats steps = hn::Mul(hn::Iota(d, 0.0f), hn::Set(d, stepX));
  const RowFloats advance = hn::Set(d, stepX * static_cast<float>(lanes));
  const RowFloats scale = hn::Set(d, static_cast<float>(1.0 / r2));
  for (int z = slices.begin; z < slices.end; ++z) {
    const double dz = z * grid.step.z - centre.z, left = r2 - dz * dz;
    if (left <= 0.0) continue;
    const VoxelRange ys = voxelsWithin(centre.y, std::sqrt(left), grid.step.y, grid.ny);
    for (int y = ys.begin; y < ys.end; ++y) {
      const double dy = y * grid.step.y - centre.y, rest = left - dy * dy;
      if (rest <= 0.0) continue;
      const VoxelRange xs = voxelsWithin(centre.x, std::sqrt(rest), grid.step.x, grid.nx);
      if (xs.begin >= xs.end) continue;
      beginRow(dy, dz);
      const RowFloats base = hn::Set(d, static_cast<float>((dy * dy + dz * dz) / r2));
      RowFloats dx = hn::Add(hn::Set(d, static_cast<float>(xs.begin * grid.step.x - centre.x)), steps);
      std::size_t at = grid.row(y, z) + static_cast<std::size_t>(xs.begin);
      for (int x = xs.begin; x < xs.end; x += lanes, at += static_cast<std::size_t>(lanes)) {
        RowFloats s = hn::MulAdd(hn::Mul(dx, dx), scale, base);
        if (x + lanes > grid.nx)  // no ball in the padding
          s = hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(grid.nx - x)), s, hn::Set(d, 1.0f));
        each(at, dx, s);
        dx = hn::Add(dx, advance);
      }
    }
    endSlice();
  }
}

}  // namespace welkin::field::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
