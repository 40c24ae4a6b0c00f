// SPDX-License-Identifier: Apache-2.0
// What points of lattices give to rows of gradient noise. Compiled for every instruction set.
#if defined(WELKIN_NOISE_GRADIENT_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_GRADIENT_POINTS_INL_H_
#undef WELKIN_NOISE_GRADIENT_POINTS_INL_H_
#else
#define WELKIN_NOISE_GRADIENT_POINTS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "welkin/noise/fill.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Words = hn::ScalableTag<std::uint32_t>;
using Bytes = hn::Repartition<std::uint8_t, Words>;
using VF = hn::Vec<Floats>;
using VU = hn::Vec<Words>;

// mix32() of each lane.
HWY_INLINE VU mixedWords(VU h) {
  const Words du;
  h = hn::Xor(h, hn::ShiftRight<16>(h));
  h = hn::Mul(h, hn::Set(du, 0x85ebca6bu));
  h = hn::Xor(h, hn::ShiftRight<13>(h));
  h = hn::Mul(h, hn::Set(du, 0xc2b2ae35u));
  return hn::Xor(h, hn::ShiftRight<16>(h));
}

// One corner of the axes beside x and y.
struct Plane {
  std::uint32_t hash;   // of those axes
  std::uint32_t index;  // on the third
  float weight;         // product of the axes' weights
  float reach[2];       // the same with an axis' reach in its weight's place, third and fourth
};

inline constexpr int kMaxPlanes = 4;

// Vectors of samples of a row that are summed side by side, and stored together.
inline constexpr int kVectors = 4;

// In a register from here on: GCC would rather load what is used twice twice.
HWY_INLINE void keep(VF& v) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2 && defined(__GNUC__) && !defined(__clang__)
  asm("" : "+v"(v.raw));
#else
  (void)v;
#endif
}

// Components of gradients by look-up of bytes. With three and four axes the upper byte of +-2 or 0
// (gradientBytesScale() undoes the 2), with two axes the upper two bytes.
template <int kAxes>
struct Gradients {
  HWY_INLINE Gradients() {
    for (int a = 0; a < kAxes; ++a) table[a] = hn::LoadDup128(Bytes(), kGradientBytes<kAxes>.component[a]);
  }

  // Where in the tables the gradient of a point hash is: the indices of the bytes of each component, 0x80 and
  // up for those that are zero.
  static HWY_INLINE VU where(VU hash) {
    const Words d;
    if constexpr (kAxes == 2) {
      const VU upper = hn::And(hash, hn::Set(d, 7u << kGradientShift));
      return hn::Or(hn::Or(upper, hn::ShiftRight<8>(upper)), hn::Set(d, 0x00088080u));
    } else {
      return hn::OrAnd(hn::Set(d, 0x00808080u), hash, hn::Set(d, 15u << kGradientShift));
    }
  }

  HWY_INLINE VF component(int axis, VU at) const {
    return hn::BitCast(Floats(), hn::TableLookupBytesOr0(table[axis], at));
  }

  hn::Vec<Bytes> table[kAxes];
};

// What a lattice point gives to its line: the parts of A that do not and that do grow with the distance in x,
// and B. Sums over the planes.
struct PointValue {
  VF level, slope, b;
};

// These of a line's points in kSlices slices, of which the second lies between the same planes of lattice
// points as the first (kShift 0) or between the first's upper one and the next (1): what does not depend on
// weights is looked up once for each plane. Components of gradients of three and four axes are 0 or +-2, so
// that their products with weights are exact, and it makes no difference whether these are looked up or
// multiplied.
template <int kAxes, int kSlices = 1, int kShift = 0>
class Points {
 public:
  static constexpr int kPlanes = 1 << (kAxes - 2);                    // of a slice
  static constexpr int kDistinct = kPlanes + (kSlices - 1) * kShift;  // of all of them

  // kMaxPlanes planes a slice.
  explicit HWY_INLINE Points(const Plane* planes) {
    const Floats d;
    for (int s = 0; s < kSlices; ++s)
      for (int p = 0; p < kPlanes; ++p) {
        const Plane& plane = planes[kMaxPlanes * s + p];
        if constexpr (kTables)
          table_[s][p] =
              weighted(plane, gradients_.where(hn::ShiftLeft<kGradientShift>(hn::Iota(Words(), 0))));
        else if constexpr (kAxes > 2) {
          weight_[s][p] = hn::Set(d, plane.weight);
          for (int i = 0; i < kAxes - 2; ++i) reach_[s][p][i] = hn::Set(d, plane.reach[i]);
        }
      }
  }

  // Of the points with these hashes in each distinct plane, by slice.
  template <class HashOf>
  HWY_INLINE void operator()(const HashOf& hashOf, PointValue* HWY_RESTRICT sums) const {
    for (int q = 0; q < kDistinct; ++q) {
      const Found found(*this, hashOf(q));
      for (int s = 0; s < kSlices; ++s) {
        const int p = q - kShift * s;
        if (p < 0 || p >= kPlanes) continue;
        PointValue& sum = sums[s];
        if (p == 0) {
          sum = one(s, p, found);
        } else if constexpr (kTables || kAxes == 4) {
          const PointValue v = one(s, p, found);
          sum = {hn::Add(sum.level, v.level), hn::Add(sum.slope, v.slope), hn::Add(sum.b, v.b)};
        } else if constexpr (kAxes == 3) {
          sum.level = hn::MulAdd(found.component[2], reach_[s][p][0], sum.level);
          sum.slope = hn::MulAdd(found.component[0], weight_[s][p], sum.slope);
          sum.b = hn::MulAdd(found.component[1], weight_[s][p], sum.b);
        }
      }
    }
  }

 private:
  // Vectors that hold a value for every gradient, looked up by a permutation of lanes.
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
  static constexpr bool kTables = hn::MaxLanes(Floats()) >= (kAxes == 2 ? 8 : 16);
#else
  static constexpr bool kTables = false;
#endif

  // What a hash gives to every slice: its place in tables, or its gradient.
  struct Found {
    HWY_INLINE Found(const Points& points, VU hash) {
      if constexpr (kTables) {
        // The processor looks at the lowest bits of an index alone.
        index = hn::ShiftRight<kGradientShift>(hash);
      } else {
        const VU at = Gradients<kAxes>::where(hash);
        for (int a = 0; a < kAxes; ++a) component[a] = points.gradients_.component(a, at);
      }
    }
    VU index;
    VF component[kAxes];
  };

  HWY_INLINE PointValue one(int s, int p, const Found& found) const {
    if constexpr (kTables) {
      const PointValue& table = table_[s][p];
      const auto look = [&](VF from) HWY_ATTR { return lookedUp(from, found.index); };
      return {kAxes == 2 ? hn::Zero(Floats()) : look(table.level), look(table.slope), look(table.b)};
    } else if constexpr (kAxes == 2) {
      return {hn::Zero(Floats()), found.component[0], found.component[1]};
    } else {
      return byWeights(found.component, weight_[s][p], reach_[s][p]);
    }
  }

  static HWY_INLINE VF lookedUp(VF from, VU index) {
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
    using Indices = decltype(hn::IndicesFromVec(Floats(), index));
    return hn::TableLookupLanes(from, Indices{index.raw});
#else
    return hn::TableLookupLanes(from, hn::IndicesFromVec(Floats(), index));
#endif
  }

  HWY_INLINE PointValue weighted(const Plane& plane, VU at) const {
    const Floats d;
    VF component[kAxes];
    for (int a = 0; a < kAxes; ++a) component[a] = gradients_.component(a, at);
    if constexpr (kAxes == 2) {
      return {hn::Zero(d), component[0], component[1]};
    } else {
      const VF reach[2] = {hn::Set(d, plane.reach[0]), hn::Set(d, plane.reach[1])};
      return byWeights(component, hn::Set(d, plane.weight), reach);
    }
  }

  static HWY_INLINE PointValue byWeights(const VF* component, VF weight, const VF* reach) {
    VF level = hn::Mul(component[2], reach[0]);
    if constexpr (kAxes == 4) level = hn::MulAdd(component[3], reach[1], level);
    return {level, hn::Mul(component[0], weight), hn::Mul(component[1], weight)};
  }

  const Gradients<kAxes> gradients_;
  PointValue table_[kSlices][kPlanes];
  VF weight_[kSlices][kPlanes], reach_[kSlices][kPlanes][2];
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
