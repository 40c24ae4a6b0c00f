// SPDX-License-Identifier: Apache-2.0
// Which feature points can be nearest to the samples of a box. Compiled for every instruction set.
//
// The difference of the squares of two points' distances is linear in the place from which they are seen, so
// that a point p is farther than a point q from every place of a box where
//   |q|^2 - |p|^2 + 2 sum over axes of h |p - q| < 0,
// p and q from the middle of the box and h half its edges. With the two points that are nearest to the middle
// as q, little more is left than what decides over some place. What is left out is farther by more than
// roundings, so that the result is exact.
#if defined(WELKIN_NOISE_CELL_NEAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_CELL_NEAR_INL_H_
#undef WELKIN_NOISE_CELL_NEAR_INL_H_
#else
#define WELKIN_NOISE_CELL_NEAR_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "welkin/noise/fill.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr float kFar = 1e9f;  // where no point is

// Places by axis. Vectors may be read over the last point, and hold kFar there.
struct NearPoints {
  float* place[3];
  int count;
};

struct NearBox {
  float lo[3], hi[3];
};

// Where values go: sample x of row y and slice z to out[z * slice + y * row + x].
struct CellOutput {
  float* out;
  std::ptrdiff_t row, slice;
  float weight, bias;  // weight times the value is added to the bias, or (add) to what is there,
  bool add;
  bool clamps;  // and clamped
  float low, high;

  HWY_INLINE float* at(int x, int y, int z) const { return out + z * slice + y * row + x; }

  template <class D, class V = hn::Vec<D>>
  HWY_INLINE void put(D d, V value, float* to) const {
    value = hn::MulAdd(hn::Set(d, weight), value, add ? hn::LoadU(d, to) : hn::Set(d, bias));
    if (HWY_UNLIKELY(clamps)) value = hn::Clamp(value, hn::Set(d, low), hn::Set(d, high));
    hn::StoreU(value, d, to);
  }
};

template <int kAxes>
class NearSearch {
 public:
  using D = hn::CappedTag<float, kTileX>;
  using DU = hn::RebindToUnsigned<D>;
  using V = hn::Vec<D>;
  using VU = hn::Vec<DU>;
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

  // `squares` has room for as many points as are searched, padded.
  NearSearch(const NearBox& box, float* squares) : squares_(squares) {
    const D d;
    for (int a = 0; a < kAxes; ++a) {
      const auto lo = hn::Set(d, box.lo[a]), hi = hn::Set(d, box.hi[a]);
      middle_[a] = hn::Mul(hn::Set(d, 0.5f), hn::Add(lo, hi));
      edge_[a] = hn::Sub(hi, lo);
    }
  }

  // Copies the points that can be the nearest to some place of the box (second: or the second nearest).
  HWY_INLINE void keep(const NearPoints& from, bool second, NearPoints& to) {
    findTwo(from);
    const D d;
    V q[2][kAxes], square[2];
    for (int n = 0; n < 2; ++n) {
      for (int a = 0; a < kAxes; ++a) q[n][a] = hn::Set(d, from.place[a][nearest_[n]]);
      square[n] = hn::Set(d, squares_[nearest_[n]] + kSlack);
    }
    int count = 0;
    for (int i = 0; i < from.count; i += kLanes) {
      const auto own = hn::Load(d, squares_ + i);
      V p[kAxes], most[2] = {hn::Sub(square[0], own), hn::Sub(square[1], own)};
      for (int a = 0; a < kAxes; ++a) {
        p[a] = hn::LoadU(d, from.place[a] + i);
        for (int n = 0; n < 2; ++n) most[n] = hn::MulAdd(edge_[a], hn::Abs(hn::Sub(p[a], q[n][a])), most[n]);
      }
      const auto rest = second ? hn::Max(most[0], most[1]) : hn::Min(most[0], most[1]);
      // Without branches, which nobody could predict: all lanes are written, those to keep first.
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::Ge(rest, hn::Zero(d)), bits);
      const unsigned kept = bits[0] & ((1u << kLanes) - 1);
      const auto order = hn::SetTableIndices(d, kKeepFirst[kept].data());
      for (int a = 0; a < kAxes; ++a) hn::StoreU(hn::TableLookupLanes(p[a], order), d, to.place[a] + count);
      count += std::popcount(kept);
    }
    to.count = count;
    for (int a = 0; a < kAxes; ++a) hn::StoreU(hn::Set(d, kFar), d, to.place[a] + count);
  }

  // After keep(): the nearest (second nearest) point is nowhere in the box farther than this (square).
  float bound(const NearPoints& from, bool second) const {
    float most = 0.0f;
    for (int n = 0; n < (second ? 2 : 1); ++n) {
      float square = 0.0f;
      for (int a = 0; a < kAxes; ++a) {
        const float middle = hn::GetLane(middle_[a]), half = 0.5f * hn::GetLane(edge_[a]);
        const float away = std::abs(from.place[a][nearest_[n]] - middle) + half;
        square += away * away;
      }
      most = std::max(most, square);
    }
    return most * 1.00001f;
  }

 private:
  static constexpr float kSlack = 1e-4f;
  // Squares give their lowest bits to the point's number, so that a minimum says whose it is.
  static constexpr std::uint32_t kNumber = 0xfff;

  HWY_INLINE void findTwo(const NearPoints& from) {
    const D d;
    const DU du;
    auto number = hn::Iota(du, 0);
    auto first = hn::Set(du, 0x7f000000u), second = first;
    for (int i = 0; i < from.count; i += kLanes) {
      auto away = hn::Sub(hn::LoadU(d, from.place[0] + i), middle_[0]);
      auto square = hn::Mul(away, away);
      for (int a = 1; a < kAxes; ++a) {
        away = hn::Sub(hn::LoadU(d, from.place[a] + i), middle_[a]);
        square = hn::MulAdd(away, away, square);
      }
      hn::Store(square, d, squares_ + i);
      const auto key = hn::OrAnd(number, hn::BitCast(du, square), hn::Set(du, ~kNumber));
      second = hn::Min(second, hn::Max(first, key));
      first = hn::Min(first, key);
      number = hn::Add(number, hn::Set(du, std::uint32_t{kLanes}));
    }
    const auto merge = [&](VU otherFirst, VU otherSecond) HWY_ATTR {
      second = hn::Min(hn::Min(second, otherSecond), hn::Max(first, otherFirst));
      first = hn::Min(first, otherFirst);
    };
    if constexpr (kLanes == 8)
      merge(hn::ConcatLowerUpper(du, first, first), hn::ConcatLowerUpper(du, second, second));
    merge(hn::Shuffle1032(first), hn::Shuffle1032(second));
    merge(hn::Shuffle2301(first), hn::Shuffle2301(second));
    nearest_[0] = hn::GetLane(first) & kNumber;
    nearest_[1] = hn::GetLane(second) & kNumber;
  }

  float* squares_;  // of the distances from the middle
  V middle_[kAxes], edge_[kAxes];
  std::uint32_t nearest_[2];
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
