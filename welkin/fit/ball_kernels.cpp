// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/ball_kernels.h"

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/fit/ball_kernels.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/highway.h>

#include "welkin/field/metaball_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::field::HWY_NAMESPACE {

using fit::BallBlock;
using fit::BallGain;
using fit::BallStep;

void addStepRows(const BallGrid& grid, const GridBall& ball, const BallStep& step, SliceRange slices,
                 float* voxels) {
  const RowLanes d;
  const double k = -2.0 * ball.weight / (ball.radius * ball.radius);
  const RowFloats w = hn::Set(d, static_cast<float>(step.weight));
  const RowFloats bx = hn::Set(d, static_cast<float>(k * step.centre.x));
  const RowFloats bs = hn::Set(d, static_cast<float>(-2.0 * ball.weight * step.logRadius));
  RowFloats b = hn::Zero(d);
  overBall(
      grid, ball, slices,
      [&](double dy, double dz)
          HWY_ATTR { b = hn::Set(d, static_cast<float>(k * (dy * step.centre.y + dz * step.centre.z))); },
      [&](std::size_t at, RowFloats dx, RowFloats s) HWY_ATTR {
        const RowFloats t = insideOf(d, s), f = kernelOf(d, s, t), g = kernelSlopeOf(d, s, t);
        const RowFloats slope = hn::MulAdd(bs, s, hn::MulAdd(bx, dx, b));
        hn::StoreU(hn::MulAdd(g, slope, hn::MulAdd(w, f, hn::LoadU(d, voxels + at))), d, voxels + at);
      },
      []() HWY_ATTR {});
}

// Sums of r f, r g d and r g s.
void gatherRows(const BallGrid& grid, const GridBall& ball, const float* r, BallStep& sums) {
  const RowLanes d;
  RowFloats f = hn::Zero(d), gx = f, gy = f, gz = f, gs = f, ry = f, rz = f;
  overBall(
      grid, ball, slicesOf(grid, ball),
      [&](double dy, double dz) HWY_ATTR {
        ry = hn::Set(d, static_cast<float>(dy));
        rz = hn::Set(d, static_cast<float>(dz));
      },
      [&](std::size_t at, RowFloats dx, RowFloats s) HWY_ATTR {
        const RowFloats t = insideOf(d, s), value = hn::LoadU(d, r + at);
        const RowFloats rg = hn::Mul(value, kernelSlopeOf(d, s, t));
        f = hn::MulAdd(value, kernelOf(d, s, t), f);
        gx = hn::MulAdd(rg, dx, gx);
        gy = hn::MulAdd(rg, ry, gy);
        gz = hn::MulAdd(rg, rz, gz);
        gs = hn::MulAdd(rg, s, gs);
      },
      [&]() HWY_ATTR {
        sums.weight += sumOf(d, f);
        sums.centre.x += sumOf(d, gx);
        sums.centre.y += sumOf(d, gy);
        sums.centre.z += sumOf(d, gz);
        sums.logRadius += sumOf(d, gs);
        f = gx = gy = gz = gs = hn::Zero(d);
      });
}

void gainRows(const BallGrid& grid, const GridBall& ball, const float* r, BallGain& gain) {
  const RowLanes d;
  RowFloats fr = hn::Zero(d), ff = fr;
  overBall(
      grid, ball, slicesOf(grid, ball), [](double, double) HWY_ATTR {},
      [&](std::size_t at, RowFloats, RowFloats s) HWY_ATTR {
        const RowFloats f = kernelOf(d, s, insideOf(d, s));
        fr = hn::MulAdd(hn::LoadU(d, r + at), f, fr);
        ff = hn::MulAdd(f, f, ff);
      },
      [&]() HWY_ATTR {
        gain.fr += sumOf(d, fr);
        gain.ff += sumOf(d, ff);
        fr = ff = hn::Zero(d);
      });
}

// The upper triangle, of products of f, g d and g s.
void blockRows(const BallGrid& grid, const GridBall& ball, BallBlock& block) {
  const RowLanes d;
  RowFloats sums[15], ry = hn::Zero(d), rz = ry;
  for (RowFloats& v : sums) v = hn::Zero(d);
  overBall(
      grid, ball, slicesOf(grid, ball),
      [&](double dy, double dz) HWY_ATTR {
        ry = hn::Set(d, static_cast<float>(dy));
        rz = hn::Set(d, static_cast<float>(dz));
      },
      [&](std::size_t, RowFloats dx, RowFloats s) HWY_ATTR {
        const RowFloats t = insideOf(d, s), g = kernelSlopeOf(d, s, t);
        const RowFloats v[5] = {kernelOf(d, s, t), hn::Mul(g, dx), hn::Mul(g, ry), hn::Mul(g, rz),
                                hn::Mul(g, s)};
        for (int i = 0, n = 0; i < 5; ++i)
          for (int j = i; j < 5; ++j, ++n) sums[n] = hn::MulAdd(v[i], v[j], sums[n]);
      },
      [&]() HWY_ATTR {
        for (int i = 0, n = 0; i < 5; ++i)
          for (int j = i; j < 5; ++j, ++n) {
            block[static_cast<std::size_t>(5 * i + j)] += sumOf(d, sums[n]);
            sums[n] = hn::Zero(d);
          }
      });
}

}  // namespace welkin::field::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace welkin::field {

HWY_EXPORT(addStepRows);
HWY_EXPORT(gatherRows);
HWY_EXPORT(gainRows);
HWY_EXPORT(blockRows);

}  // namespace welkin::field

namespace welkin::fit {

using namespace field;  // where the vectors' code is

void addBallStep(const BallGrid& grid, const GridBall& ball, const BallStep& step, SliceRange slices,
                 float* voxels) {
  HWY_DYNAMIC_DISPATCH(addStepRows)(grid, ball, step, slices, voxels);
}

BallStep gatherBall(const BallGrid& grid, const GridBall& ball, const float* r) {
  BallStep sums;
  HWY_DYNAMIC_DISPATCH(gatherRows)(grid, ball, r, sums);
  const double k = -2.0 * ball.weight;
  return {sums.weight, k / (ball.radius * ball.radius) * sums.centre, k * sums.logRadius};
}

BallGain gainOfBall(const BallGrid& grid, const GridBall& ball, const float* r) {
  BallGain gain;
  HWY_DYNAMIC_DISPATCH(gainRows)(grid, ball, r, gain);
  return gain;
}

BallBlock blockOfBall(const BallGrid& grid, const GridBall& ball) {
  BallBlock block{};
  HWY_DYNAMIC_DISPATCH(blockRows)(grid, ball, block);
  const double k = -2.0 * ball.weight, c = k / (ball.radius * ball.radius);
  const double scale[5] = {1.0, c, c, c, k};
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = i; j < 5; ++j) block[5 * j + i] = block[5 * i + j] *= scale[i] * scale[j];
  return block;
}

}  // namespace welkin::fit

#endif
