// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/metaball_grid.h"

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/field/metaball_grid.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/highway.h>

#include "welkin/field/metaball_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::field::HWY_NAMESPACE {

void addBallRows(const BallGrid& grid, const GridBall& ball, double factor, SliceRange slices,
                 float* voxels) {
  const RowLanes d;
  const RowFloats w = hn::Set(d, static_cast<float>(factor));
  overBall(
      grid, ball, slices, [](double, double) HWY_ATTR {},
      [&](std::size_t at, RowFloats, RowFloats s) HWY_ATTR {
        const RowFloats f = kernelOf(d, s, insideOf(d, s));
        hn::StoreU(hn::MulAdd(w, f, hn::LoadU(d, voxels + at)), d, voxels + at);
      },
      []() HWY_ATTR {});
}

}  // namespace welkin::field::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace welkin::field {

HWY_EXPORT(addBallRows);

void addBall(const BallGrid& grid, const GridBall& ball, double factor, SliceRange slices, float* voxels) {
  HWY_DYNAMIC_DISPATCH(addBallRows)(grid, ball, factor, slices, voxels);
}

}  // namespace welkin::field

#endif
