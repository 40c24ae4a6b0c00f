// SPDX-License-Identifier: Apache-2.0
// Distances to the nearest point over tiles of 8 x 8 x 8 samples. Compiled for every instruction set.
//
// Of the points that can matter in the tile, those that can in a cube of 4 x 4 x 4 samples are few. All
// samples of the cube are then worked on together, in registers: a vector is two rows of four samples, and
// each point costs a multiply-add and a minimum a vector.
#if defined(WELKIN_NOISE_CELL_CUBES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_CELL_CUBES_INL_H_
#undef WELKIN_NOISE_CELL_CUBES_INL_H_
#else
#define WELKIN_NOISE_CELL_CUBES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "welkin/noise/cell_near-inl.h"
#include "welkin/noise/fill.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class CellCubes {
 public:
  using D = hn::CappedTag<float, kTileX>;
  using V = hn::Vec<D>;
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  static constexpr int kCube = 4;  // samples on an edge

  CellCubes() = default;
  // `most` points at most.
  CellCubes(const CellTables& tables, const Block& block, std::size_t most, Scratch& scratch) {
    const int first[3] = {block.x, block.y, block.z}, samples[3] = {block.width, block.rows, block.slices};
    for (int a = 0; a < 3; ++a) {
      const CellPlaces& p = tables.axis[a];
      float* place = scratch.take<float>(static_cast<std::size_t>(samples[a]));
      for (int i = 0; i < samples[a]; ++i) {
        const int at = first[a] + i, tile = first[a] + i / kTileX * kTileX;
        place[i] = static_cast<float>(p.cell[at] - p.cell[tile]) + p.inside[at];
      }
      place_[a] = place;
    }
    // By lane: the four samples of a row again and again; rows each four times.
    float* x = scratch.take<float>(static_cast<std::size_t>(samples[0] / kCube) * kLanes);
    for (int i = 0; i < samples[0] / kCube * kLanes; ++i) x[i] = place_[0][i / kLanes * kCube + i % kCube];
    float* y = scratch.take<float>(static_cast<std::size_t>(samples[1]) * kCube);
    for (int i = 0; i < samples[1] * kCube; ++i) y[i] = place_[1][i / kCube];
    rowsX_ = x;
    rowsY_ = y;
    for (float*& q : near_) q = scratch.take<float>(kCubes * (most + 2 * kLanes));
    squares_ = scratch.take<float>(most + 2 * kLanes);
  }

  // The tile from these samples on. Returns the square of the greatest distance.
  HWY_INLINE float fillTile(int x, int y, int z, const NearPoints& points, const CellOutput& to) {
    const D d;
    // All that each cube needs first: one search does not wait for the one before, as a cube's values wait
    // for its search.
    const std::ptrdiff_t stride = points.count + 2 * kLanes;
    int count[kCubes];
    for (int c = 0; c < kCubes; ++c)
      count[c] =
          keepNear(x + kCube * (c & 1), y + kCube * (c >> 1 & 1), z + kCube * (c >> 2), points, c * stride);
    auto greatest = hn::Zero(d);
    for (int c = 0; c < kCubes; ++c)
      greatest = hn::Max(greatest, fillCube(x + kCube * (c & 1), y + kCube * (c >> 1 & 1),
                                            z + kCube * (c >> 2), c * stride, count[c], to));
    return hn::GetLane(hn::MaxOfLanes(d, greatest));
  }

 private:
  static constexpr int kCubes = 8;  // of a tile

  // Keeps the points that matter in the cube from these samples on, from `to` in near_ on; returns their
  // number.
  HWY_INLINE int keepNear(int x, int y, int z, const NearPoints& points, std::ptrdiff_t to) {
    const int begin[3] = {x, y, z};
    NearBox box;
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = place_[a][begin[a]];
      box.hi[a] = place_[a][begin[a] + kCube - 1];
    }
    NearPoints kept{{near_[0] + to, near_[1] + to, near_[2] + to}, 0};
    NearSearch<3>(box, squares_).keep(points, false, kept);
    return kept.count;
  }

  // Vectors of a slice, and slices that fit the registers beside one another.
  static constexpr int kVectors = kCube * kCube / kLanes, kSlices = kLanes == 8 ? 4 : 2;

  HWY_INLINE V fillCube(int x, int y, int z, std::ptrdiff_t from, int count, const CellOutput& to) const {
    const D d;
    const float* HWY_RESTRICT near[3] = {near_[0] + from, near_[1] + from, near_[2] + from};
    const auto px = hn::Load(d, rowsX_ + std::ptrdiff_t{x / kCube} * kLanes);
    V py[kVectors];
    for (int v = 0; v < kVectors; ++v)
      py[v] = hn::Load(d, rowsY_ + std::ptrdiff_t{y} * kCube + std::ptrdiff_t{v} * kLanes);
    auto greatest = hn::Zero(d);
    for (int s = z; s < z + kCube; s += kSlices) {
      V pz[kSlices], least[kSlices][kVectors];
      for (int k = 0; k < kSlices; ++k) {
        pz[k] = hn::Set(d, place_[2][s + k]);
        for (int v = 0; v < kVectors; ++v) least[k][v] = hn::Set(d, kFar);
      }
      for (int q = 0; q < count; ++q) {
        const auto dx = hn::Sub(hn::Set(d, near[0][q]), px), xx = hn::Mul(dx, dx);
        const auto qy = hn::Set(d, near[1][q]), qz = hn::Set(d, near[2][q]);
        V flat[kVectors];
        for (int v = 0; v < kVectors; ++v) {
          const auto dy = hn::Sub(qy, py[v]);
          flat[v] = hn::MulAdd(dy, dy, xx);
        }
        for (int k = 0; k < kSlices; ++k) {
          const auto dz = hn::Sub(qz, pz[k]);
          for (int v = 0; v < kVectors; ++v) least[k][v] = hn::Min(least[k][v], hn::MulAdd(dz, dz, flat[v]));
        }
      }
      for (int k = 0; k < kSlices; ++k) {
        float* out = to.at(x, y, s + k);
        for (int v = 0; v < kVectors; ++v, out += kLanes / kCube * to.row) {
          greatest = hn::Max(greatest, least[k][v]);
          put(hn::Sqrt(least[k][v]), to, out);
        }
      }
    }
    return greatest;
  }

  // One or two rows of four values. A template, so that what does not fit the vectors is not compiled.
  template <class Values>
  static HWY_INLINE void put(Values value, const CellOutput& to, float* out) {
    const hn::CappedTag<float, kCube> d;
    if constexpr (kLanes == 2 * kCube) {
      to.put(d, hn::LowerHalf(d, value), out);
      to.put(d, hn::UpperHalf(d, value), out + to.row);
    } else {
      to.put(d, value, out);
    }
  }

  const float *place_[3], *rowsX_, *rowsY_;  // of samples, relative to their tile's first cell
  float* near_[3];                           // places of what matters in each cube
  float* squares_;                           // of distances
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
