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
struct Gradients {
  HWY_INLINE Gradients() {
    for (int a = 0; a < kAxes; ++a) table[a] = hn::LoadDup128(Bytes(), gradientBytes(kAxes).component[a]);
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

// A strip of the box, chunk after chunk of rows.
class GradientRows {
 public:
  GradientRows(const GradientTables& tables, Scratch& scratch, int x, int width)
      : tables_(tables), x_(x), width_(padded(width)) {
    const auto terms = static_cast<std::size_t>(tables.terms);
    lines_ = scratch.take<float>(terms * kLines * kLineStride);
    planes_ = scratch.take<Plane>(kMaxPlanes * terms);
    factors_ = scratch.take<float*>(terms);
    points_ = scratch.take<std::uint32_t>(std::size_t{2} * kLines * kMaxPlanes * kStrip);
    for (std::size_t t = 0; t < terms; ++t) {
      const int axes = tables.term[t].lattice->axes();
      factors_[t] = scratch.take<float>((std::size_t{1} << (axes - 2)) * 2 * axes * kStrip);
    }
  }

  void beginSlice(int z) {
    for (int t = 0; t < tables_.terms; ++t) makePlanes(t, z);
    fresh_ = true;
  }

  // The rows of every sum from y on that are in the same chunk, at most `rows`; returns their number. Row r of
  // sum s goes to out[s] + r * kStrip. Chunks of a slice must follow one another.
  int fillChunk(int y, int rows, float* const* out) {
    const int chunk = (y + tables_.lead) / kChunk;
    rows = HWY_MIN(rows, (chunk + 1) * kChunk - tables_.lead - y);
    const ChunkLines* lines = tables_.chunks + static_cast<std::ptrdiff_t>(chunk) * tables_.terms;
    for (int t = 0; t < tables_.terms; ++t) {
      const std::uint32_t left = fresh_ ? 0 : lines[t].left;
      if (left < lines[t].count) expand(t, lines[t].line + left, static_cast<int>(lines[t].count - left));
    }
    fresh_ = false;
    for (int s = 0; s < tables_.sums; ++s) {
      const int first = tables_.first[s], terms = tables_.first[s + 1] - first;
      const RowPlace* places = tables_.rows + static_cast<std::ptrdiff_t>(y) * tables_.terms + first;
      switch (tables_.fractal) {
        case Fractal::kFbm:
          sum<Fractal::kFbm>(first, terms, places, rows, out[s]);
          break;
        case Fractal::kBillow:
          sum<Fractal::kBillow>(first, terms, places, rows, out[s]);
          break;
        case Fractal::kRidged:
          sum<Fractal::kRidged>(first, terms, places, rows, out[s]);
          break;
      }
    }
    return rows;
  }

 private:
  static constexpr std::size_t kMaxPlanes = 4;

  // One corner of the axes beside x and y.
  struct Plane {
    std::uint32_t hash;   // of those axes
    std::uint32_t index;  // on the third
  };

  // The products of the factors of x and of the outer axes: for each plane and component of the gradient
  // those of the lower corner in x, then of the upper one.
  void makePlanes(int t, int z) {
    const TermTables& term = tables_.term[t];
    const Place outer[2] = {term.z != nullptr ? term.z[z] : term.time, term.time};
    const int axes = term.lattice->axes();
    const Floats d;
    float* next = factors_[t];
    for (int p = 0; p < 1 << (axes - 2); ++p) {
      Plane& plane = planes_[kMaxPlanes * t + p];
      plane = {0, 0};
      float scale[4] = {1.0f, 1.0f, 1.0f, 1.0f};
      for (int e = 2; e < axes; ++e) {
        const bool high = (p >> (e - 2) & 1) != 0;
        const Corner& corner = high ? outer[e - 2].high : outer[e - 2].low;
        const std::uint32_t index = high ? outer[e - 2].highIndex : outer[e - 2].lowIndex;
        if (e == 2) plane.index = index;
        plane.hash += term.lattice->axis(e).hash(index);
        for (int c = 0; c < axes; ++c) scale[c] *= c == e ? corner.reach : corner.weight;
      }
      for (int c = 0; c < axes; ++c, next += std::ptrdiff_t{2} * kStrip) {
        const auto by = hn::Set(d, scale[c]);
        const float* low = (c == 0 ? term.x.lowReach : term.x.lowWeight) + x_;
        const float* high = (c == 0 ? term.x.highReach : term.x.highWeight) + x_;
        for (int i = 0; i < width_; i += static_cast<int>(hn::Lanes(d))) {
          hn::Store(hn::Mul(by, hn::LoadU(d, low + i)), d, next + i);
          hn::Store(hn::Mul(by, hn::LoadU(d, high + i)), d, next + kStrip + i);
        }
      }
    }
  }

  void expand(int t, const LineRef* lines, int count) {
    switch (tables_.term[t].lattice->axes()) {
      case 2:
        return expandLines<2>(t, lines, count);
      case 3:
        return expandLines<3>(t, lines, count);
      default:
        return expandLines<4>(t, lines, count);
    }
  }

  template <int kAxes>
  HWY_NOINLINE void expandLines(int t, const LineRef* lines, int count) {
    const Floats d;
    const Words du;
    const TermTables& term = tables_.term[t];
    constexpr int kPlanes = 1 << (kAxes - 2);
    const Gradients<kAxes> gradients;
    const std::uint32_t* HWY_RESTRICT lowHash = term.x.lowHash + x_;
    const std::uint32_t* HWY_RESTRICT highHash = term.x.highHash + x_;
    std::ptrdiff_t lineHashes = 0, planeHashes = 0;  // distances of their hashes
    std::uint32_t rows[kLines][kPlanes];
    float* HWY_RESTRICT out[kLines];
    for (int n = 0; n < count; ++n) {
      out[n] = lines_ + lines[n].offset;
      const std::uint32_t hash = term.lattice->axis(1).hash(lines[n].index);
      for (int p = 0; p < kPlanes; ++p) rows[n][p] = rowHash(hash + planes_[kMaxPlanes * t + p].hash);
    }
    if (term.lattice->published()) {
      planeHashes = std::ptrdiff_t{2} * kStrip;
      lineHashes = planeHashes * kPlanes;
      for (int n = 0; n < count; ++n)
        for (int p = 0; p < kPlanes; ++p) {
          publishedHashes(term, lines[n].index, planes_[kMaxPlanes * t + p].index,
                          points_ + n * lineHashes + p * planeHashes);
          rows[n][p] = 1;
        }
      lowHash = points_;
      highHash = points_ + kStrip;
    }
    const float* HWY_RESTRICT factors = factors_[t];
    const int width = width_;
    for (int i = 0; i < width; i += static_cast<int>(hn::Lanes(d))) {
      for (int n = 0; n < count; ++n) {
        auto a = hn::Zero(d), b = hn::Zero(d);
        for (int p = 0; p < kPlanes; ++p) {
          const auto row = hn::Set(du, rows[n][p]);
          const std::ptrdiff_t at = n * lineHashes + p * planeHashes + i;
          const auto low = gradients.where(hn::Mul(hn::LoadU(du, lowHash + at), row));
          const auto high = gradients.where(hn::Mul(hn::LoadU(du, highHash + at), row));
          for (int c = 0; c < kAxes; ++c) {
            const float* factor = factors + std::ptrdiff_t{2} * (p * kAxes + c) * kStrip + i;
            auto& to = c == 1 ? b : a;
            to = hn::MulAdd(gradients.component(c, low), hn::Load(d, factor), to);
            to = hn::MulAdd(gradients.component(c, high), hn::Load(d, factor + kStrip), to);
          }
        }
        hn::Store(a, d, out[n] + i);
        hn::Store(b, d, out[n] + kStrip + i);
      }
    }
  }

  // Perlin's own chain of look-ups, put where the hash's bits are.
  void publishedHashes(const TermTables& term, std::uint32_t y, std::uint32_t z, std::uint32_t* out) const {
    const auto& p = kPublishedPermutation;
    for (int side = 0; side < 2; ++side) {
      const std::uint32_t* x = (side == 0 ? term.x.lowHash : term.x.highHash) + x_;
      for (int i = 0; i < width_; ++i)
        out[side * kStrip + i] = static_cast<std::uint32_t>(p[(p[(p[x[i] & 255] + y) & 255] + z) & 255])
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
  HWY_INLINE void sum(int first, int terms, const RowPlace* places, int rows, float* HWY_RESTRICT out) const {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d)), width = width_;
    const auto bias = hn::Set(d, tables_.bias);
    const float* HWY_RESTRICT lines = lines_;
    for (int r = 0; r < rows; ++r, places += tables_.terms, out += kStrip)
      for (int i = 0; i < width; i += 4 * lanes) {
        auto s0 = bias, s1 = bias, s2 = bias, s3 = bias;
        for (int t = 0; t < terms; ++t) {
          const RowPlace& p = places[t];
          const float* low = lines + p.lines[0] + i;
          const float* high = lines + p.lines[1] + i;
          const auto w0 = hn::Set(d, p.weights[0]), r0 = hn::Set(d, p.weights[1]);
          const auto w1 = hn::Set(d, p.weights[2]), r1 = hn::Set(d, p.weights[3]);
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
  bool fresh_ = true;      // no lines are left
  float* lines_;           // kLines a term
  Plane* planes_;          // kMaxPlanes a term
  float** factors_;        // of a term
  std::uint32_t* points_;  // published hashes: of a line, a plane, the lower corners, then the upper ones
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
