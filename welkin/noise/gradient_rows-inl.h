// SPDX-License-Identifier: Apache-2.0
// Rows of sums of gradient noise (fill.h says how). Compiled for every instruction set.
//
// The order of operations on a sample is the same for any width of vectors and any block, and each is either
// exact or rounded by IEEE 754, so that only the fusing of multiplication and addition sets targets apart.
#if defined(WELKIN_NOISE_GRADIENT_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_GRADIENT_ROWS_INL_H_
#undef WELKIN_NOISE_GRADIENT_ROWS_INL_H_
#else
#define WELKIN_NOISE_GRADIENT_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <utility>

#include "welkin/noise/fill.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Words = hn::ScalableTag<std::uint32_t>;
using Bytes = hn::Repartition<std::uint8_t, Words>;
using VF = hn::Vec<Floats>;
using VU = hn::Vec<Words>;

// Components of gradients by look-up of bytes. With three and four axes the upper byte of +-2 or 0
// (GradientBytes::kScale undoes the 2), with two axes the upper two bytes.
template <int kAxes>
class Gradients {
 public:
  HWY_INLINE explicit Gradients(const GradientBytes& bytes) : bytes_(bytes) {}

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

  HWY_INLINE VF component(int axis, VU where) const {
    const auto table = hn::LoadDup128(Bytes(), bytes_.component[axis]);
    return hn::BitCast(Floats(), hn::TableLookupBytesOr0(table, where));
  }

 private:
  const GradientBytes& bytes_;
};

// Factors of one plane of lattice points (one corner of the axes beside x and y), by sample of the row.
struct PlaneFactors {
  const float* low[4];   // of the lower corner in x: for the components x, y and those of the outer axes
  const float* high[4];  // of the upper
  std::uint32_t hash;    // of the outer axes
  std::uint32_t index;   // on the third axis
};

// A strip of the box, row after row.
class GradientRows {
 public:
  GradientRows(const GradientTables& tables, Scratch& scratch, int x, int width)
      : tables_(tables), x_(x), width_(padded(width)) {
    const auto terms = static_cast<std::size_t>(tables.terms);
    lines_ = scratch.take<Line>(2 * terms);
    rows_ = scratch.take<const float*>(2 * terms);
    planes_ = scratch.take<PlaneFactors>(kMaxPlanes * terms);
    factors_ = scratch.take<float*>(terms);
    points_ = scratch.take<std::uint32_t>(std::size_t{2} * kStrip);
    for (std::size_t i = 0; i < 2 * terms; ++i)
      lines_[i].values = scratch.take<float>(std::size_t{2} * kStrip);
    for (std::size_t t = 0; t < terms; ++t) {
      const int outer = tables.term[t].outerAxes;
      factors_[t] =
          outer == 0 ? nullptr : scratch.take<float>((std::size_t{1} << outer) * 2 * (2 + outer) * kStrip);
    }
  }

  void beginSlice(int z) {
    for (int t = 0; t < tables_.terms; ++t) {
      makePlanes(t, z);
      lines_[2 * t].made = lines_[2 * t + 1].made = false;
    }
  }

  // One row of every sum; out[s] has room for a padded strip.
  void row(int y, float* const* out) {
    const std::size_t at = static_cast<std::size_t>(y) * tables_.terms;
    for (int t = 0; t < tables_.terms; ++t) {
      const std::uint32_t* index = tables_.yIndices[at + t];
      Line &low = lines_[2 * t], &high = lines_[2 * t + 1];
      if (low.made && low.index == index[0] && high.index == index[1]) continue;
      if (low.made && high.index == index[0]) std::swap(low, high);
      if (!low.made || low.index != index[0]) expand(t, index[0], low);
      if (!high.made || high.index != index[1]) expand(t, index[1], high);
      rows_[2 * t] = low.values;
      rows_[2 * t + 1] = high.values;
    }
    for (int s = 0; s < tables_.sums; ++s) {
      const int first = tables_.first[s], terms = tables_.first[s + 1] - first;
      const float(*weights)[4] = tables_.yWeights + at + first;
      switch (tables_.fractal) {
        case Fractal::kFbm:
          sum<Fractal::kFbm>(first, terms, weights, out[s]);
          break;
        case Fractal::kBillow:
          sum<Fractal::kBillow>(first, terms, weights, out[s]);
          break;
        case Fractal::kRidged:
          sum<Fractal::kRidged>(first, terms, weights, out[s]);
          break;
      }
    }
  }

 private:
  static constexpr std::size_t kMaxPlanes = 4;

  // A row of lattice points as the samples see it: A, then B.
  struct Line {
    std::uint32_t index;
    bool made;
    float* values;
  };

  void makePlanes(int t, int z) {
    const TermTables& term = tables_.term[t];
    const RowPlaces& x = term.x;
    const Place outer[2] = {term.z != nullptr ? term.z[z] : term.time, term.time};
    const Floats d;
    float* next = factors_[t];
    for (int p = 0; p < 1 << term.outerAxes; ++p) {
      PlaneFactors& plane = planes_[kMaxPlanes * t + p];
      plane.hash = 0;
      if (term.outerAxes == 0) {
        plane.low[0] = x.lowReach + x_, plane.low[1] = x.lowWeight + x_;
        plane.high[0] = x.highReach + x_, plane.high[1] = x.highWeight + x_;
        continue;
      }
      // Products of the outer axes' factors: for the components x and y, then for each outer one.
      float scale[4] = {1.0f, 1.0f, 1.0f, 1.0f};
      for (int e = 0; e < term.outerAxes; ++e) {
        const bool high = (p >> e & 1) != 0;
        const Corner& corner = high ? outer[e].high : outer[e].low;
        const std::uint32_t index = high ? outer[e].highIndex : outer[e].lowIndex;
        if (e == 0) plane.index = index;
        plane.hash += term.lattice->axis(2 + e).hash(index);
        for (int c = 0; c < 2 + term.outerAxes; ++c) scale[c] *= c == 2 + e ? corner.reach : corner.weight;
      }
      for (int c = 0; c < 2 + term.outerAxes; ++c) {
        const auto by = hn::Set(d, scale[c]);
        const float* low = (c == 0 ? x.lowReach : x.lowWeight) + x_;
        const float* high = (c == 0 ? x.highReach : x.highWeight) + x_;
        for (int i = 0; i < width_; i += static_cast<int>(hn::Lanes(d))) {
          hn::Store(hn::Mul(by, hn::LoadU(d, low + i)), d, next + i);
          hn::Store(hn::Mul(by, hn::LoadU(d, high + i)), d, next + kStrip + i);
        }
        plane.low[c] = next;
        plane.high[c] = next + kStrip;
        next += std::ptrdiff_t{2} * kStrip;
      }
    }
  }

  void expand(int t, std::uint32_t index, Line& line) {
    line.index = index;
    line.made = true;
    switch (tables_.term[t].outerAxes) {
      case 0:
        return expandRow<2>(t, index, line.values);
      case 1:
        return expandRow<3>(t, index, line.values);
      default:
        return expandRow<4>(t, index, line.values);
    }
  }

  template <int kAxes>
  HWY_NOINLINE void expandRow(int t, std::uint32_t index, float* out) {
    const Floats d;
    const Words du;
    const TermTables& term = tables_.term[t];
    constexpr int kPlanes = 1 << (kAxes - 2);
    const PlaneFactors* planes = planes_ + kMaxPlanes * t;
    const Gradients<kAxes> gradients(gradientBytes(kAxes));
    const std::uint32_t rowSum = term.lattice->axis(1).hash(index);
    const bool published = term.lattice->published();
    for (int p = 0; p < kPlanes; ++p) {
      const PlaneFactors& f = planes[p];
      const auto rowFactor = hn::Set(du, published ? 1u : rowHash(rowSum + f.hash));
      const std::uint32_t* lowHash = term.x.lowHash + x_;
      const std::uint32_t* highHash = term.x.highHash + x_;
      if (published) {
        publishedHashes(term, index, f.index);
        lowHash = points_;
        highHash = points_ + kStrip;
      }
      for (int i = 0; i < width_; i += static_cast<int>(hn::Lanes(d))) {
        const auto low = gradients.where(hn::Mul(hn::LoadU(du, lowHash + i), rowFactor));
        const auto high = gradients.where(hn::Mul(hn::LoadU(du, highHash + i), rowFactor));
        auto a = p == 0 ? hn::Zero(d) : hn::Load(d, out + i);
        auto b = p == 0 ? hn::Zero(d) : hn::Load(d, out + kStrip + i);
        for (int c = 0; c < kAxes; ++c) {
          auto& to = c == 1 ? b : a;
          to = hn::MulAdd(gradients.component(c, low), hn::LoadU(d, f.low[c] + i), to);
          to = hn::MulAdd(gradients.component(c, high), hn::LoadU(d, f.high[c] + i), to);
        }
        hn::Store(a, d, out + i);
        hn::Store(b, d, out + kStrip + i);
      }
    }
  }

  // Perlin's own chain of look-ups, put where the hash's bits are.
  void publishedHashes(const TermTables& term, std::uint32_t y, std::uint32_t z) {
    const auto& p = kPublishedPermutation;
    for (int side = 0; side < 2; ++side) {
      const std::uint32_t* x = (side == 0 ? term.x.lowHash : term.x.highHash) + x_;
      for (int i = 0; i < width_; ++i)
        points_[side * kStrip + i] = static_cast<std::uint32_t>(p[(p[(p[x[i] & 255] + y) & 255] + z) & 255])
                                     << kGradientShift;
    }
  }

  template <Fractal kFractal>
  static HWY_INLINE VF shaped(VF n, VF sum, float weight) {
    const Floats d;
    const auto one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), w = hn::Set(d, weight);
    if constexpr (kFractal == Fractal::kBillow) return hn::MulAdd(w, hn::MulSub(two, hn::Abs(n), one), sum);
    const auto rest = hn::Sub(one, hn::Abs(n));
    return hn::MulAdd(w, hn::MulSub(hn::Mul(two, rest), rest, one), sum);
  }

  template <Fractal kFractal>
  static HWY_INLINE VF added(VF sum, const float* low, const float* high, VF w0, VF r0, VF w1, VF r1,
                             float weight) {
    const Floats d;
    auto n = kFractal == Fractal::kFbm ? sum : hn::Zero(d);
    n = hn::MulAdd(w0, hn::Load(d, low), n);
    n = hn::MulAdd(r0, hn::Load(d, low + kStrip), n);
    n = hn::MulAdd(w1, hn::Load(d, high), n);
    n = hn::MulAdd(r1, hn::Load(d, high + kStrip), n);
    if constexpr (kFractal == Fractal::kFbm) return n;
    return shaped<kFractal>(n, sum, weight);
  }

  template <Fractal kFractal>
  HWY_INLINE void sum(int first, int terms, const float (*weights)[4], float* HWY_RESTRICT out) const {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto bias = hn::Set(d, tables_.bias);
    for (int i = 0; i < width_; i += 4 * lanes) {
      auto s0 = bias, s1 = bias, s2 = bias, s3 = bias;
      for (int t = 0; t < terms; ++t) {
        const float* low = rows_[2 * (first + t)] + i;
        const float* high = rows_[2 * (first + t) + 1] + i;
        const auto w0 = hn::Set(d, weights[t][0]), r0 = hn::Set(d, weights[t][1]);
        const auto w1 = hn::Set(d, weights[t][2]), r1 = hn::Set(d, weights[t][3]);
        const float w = kFractal == Fractal::kFbm ? 0.0f : tables_.term[first + t].weight;
        s0 = added<kFractal>(s0, low, high, w0, r0, w1, r1, w);
        s1 = added<kFractal>(s1, low + lanes, high + lanes, w0, r0, w1, r1, w);
        s2 = added<kFractal>(s2, low + 2 * lanes, high + 2 * lanes, w0, r0, w1, r1, w);
        s3 = added<kFractal>(s3, low + 3 * lanes, high + 3 * lanes, w0, r0, w1, r1, w);
      }
      hn::Store(s0, d, out + i);
      hn::Store(s1, d, out + i + lanes);
      hn::Store(s2, d, out + i + 2 * lanes);
      hn::Store(s3, d, out + i + 3 * lanes);
    }
  }

  const GradientTables& tables_;
  int x_, width_;
  Line* lines_;            // two a term: below and above the row
  const float** rows_;     // their values
  PlaneFactors* planes_;   // kMaxPlanes a term
  float** factors_;        // the planes' memory
  std::uint32_t* points_;  // a row of hashes below, one above
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
