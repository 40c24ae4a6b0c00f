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

// mix32() of each lane.
HWY_INLINE VU mixedWords(VU h) {
  const Words du;
  h = hn::Xor(h, hn::ShiftRight<16>(h));
  h = hn::Mul(h, hn::Set(du, 0x85ebca6bu));
  h = hn::Xor(h, hn::ShiftRight<13>(h));
  h = hn::Mul(h, hn::Set(du, 0xc2b2ae35u));
  return hn::Xor(h, hn::ShiftRight<16>(h));
}

// Components of gradients by look-up of bytes. With three and four axes the upper byte of +-2 or 0
// (GradientBytes::kScale undoes the 2), with two axes the upper two bytes.
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

  // The rows of every sum from y on that are in the same chunk, at most `rows`; returns their number. Row r
  // of sum s goes to out[s] + r * kStrip. Chunks of a slice must follow one another.
  int fillChunk(int y, int rows, float* const* out) {
    const int chunk = (y + tables_.lead) / kChunk;
    rows = HWY_MIN(rows, (chunk + 1) * kChunk - tables_.lead - y);
    const ChunkLines* lines = tables_.chunks + static_cast<std::ptrdiff_t>(chunk) * tables_.terms;
    for (int t = 0; t < tables_.terms; ++t) {
      const std::uint32_t left = fresh_ ? 0 : lines[t].left;
      if (left < lines[t].count)
        expand(t, lines[t].line + left, lines[t].hash + left, static_cast<int>(lines[t].count - left));
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

  void expand(int t, const LineRef* lines, const std::uint32_t* hashes, int count) {
    switch (tables_.term[t].lattice->axes()) {
      case 2:
        return expandLines<2>(t, lines, hashes, count);
      case 3:
        return expandLines<3>(t, lines, hashes, count);
      default:
        return expandLines<4>(t, lines, hashes, count);
    }
  }

  template <int kAxes>
  HWY_NOINLINE void expandLines(int t, const LineRef* lines, const std::uint32_t* hashes, int count) {
    const Words du;
    const TermTables& term = tables_.term[t];
    constexpr int kPlanes = 1 << (kAxes - 2);
    const Gradients<kAxes> gradients;
    const std::uint32_t* HWY_RESTRICT lowHash = term.x.lowHash + x_;
    const std::uint32_t* HWY_RESTRICT highHash = term.x.highHash + x_;
    std::ptrdiff_t lineHashes = 0, planeHashes = 0;  // distances of their hashes
    HWY_ALIGN std::uint32_t rows[kPlanes][padded(kLines)];
    for (int p = 0; p < kPlanes; ++p)
      for (int n = 0; n < count; n += static_cast<int>(hn::Lanes(du))) {
        const auto sum = hn::Add(hn::LoadU(du, hashes + n), hn::Set(du, planes_[kMaxPlanes * t + p].hash));
        hn::Store(hn::Or(mixedWords(sum), hn::Set(du, 1u)), du, rows[p] + n);
      }
    if (term.lattice->published()) {
      planeHashes = std::ptrdiff_t{2} * kStrip;
      lineHashes = planeHashes * kPlanes;
      for (int n = 0; n < count; ++n)
        for (int p = 0; p < kPlanes; ++p) {
          publishedHashes(term, lines[n].index, planes_[kMaxPlanes * t + p].index,
                          points_ + n * lineHashes + p * planeHashes);
          rows[p][n] = 1;
        }
      lowHash = points_;
      highHash = points_ + kStrip;
    }
    // Two lines at a time share the loads of factors.
    int n = 0;
    for (; n + 2 <= count; n += 2)
      expandSome<kAxes, 2>(t, lowHash + n * lineHashes, highHash + n * lineHashes, lineHashes, planeHashes,
                           lines + n, &rows[0][n], padded(kLines));
    if (n < count)
      expandSome<kAxes, 1>(t, lowHash + n * lineHashes, highHash + n * lineHashes, lineHashes, planeHashes,
                           lines + n, &rows[0][n], padded(kLines));
  }

  template <int kAxes, int kCount>
  HWY_INLINE void expandSome(int t, const std::uint32_t* HWY_RESTRICT lowHash,
                             const std::uint32_t* HWY_RESTRICT highHash, std::ptrdiff_t lineHashes,
                             std::ptrdiff_t planeHashes, const LineRef* lines, const std::uint32_t* rows,
                             int rowStride) const {
    const Floats d;
    const Words du;
    constexpr int kPlanes = 1 << (kAxes - 2);
    const Gradients<kAxes> gradients;
    const float* HWY_RESTRICT factors = factors_[t];
    float* HWY_RESTRICT out[kCount];
    VU row[kPlanes][kCount];
    for (int n = 0; n < kCount; ++n) {
      out[n] = lines_ + lines[n].offset;
      for (int p = 0; p < kPlanes; ++p) row[p][n] = hn::Set(du, rows[p * rowStride + n]);
    }
    const int width = width_;
    for (int i = 0; i < width; i += static_cast<int>(hn::Lanes(d))) {
      VF a[kPlanes][kCount], b[kPlanes][kCount];  // apart, for short chains of additions
      for (int p = 0; p < kPlanes; ++p) {
        VU low[kCount], high[kCount];
        for (int n = 0; n < kCount; ++n) {
          const std::ptrdiff_t at = n * lineHashes + p * planeHashes + i;
          low[n] = gradients.where(hn::Mul(hn::LoadU(du, lowHash + at), row[p][n]));
          high[n] = gradients.where(hn::Mul(hn::LoadU(du, highHash + at), row[p][n]));
        }
        for (int c = 0; c < kAxes; ++c) {
          const float* factor = factors + std::ptrdiff_t{2} * (p * kAxes + c) * kStrip + i;
          const auto atLow = hn::Load(d, factor), atHigh = hn::Load(d, factor + kStrip);
          VF* to = c == 1 ? b[p] : a[p];
          for (int n = 0; n < kCount; ++n) {
            const auto g = gradients.component(c, low[n]);
            to[n] = c < 2 ? hn::Mul(g, atLow) : hn::MulAdd(g, atLow, to[n]);
          }
          for (int n = 0; n < kCount; ++n) to[n] = hn::MulAdd(gradients.component(c, high[n]), atHigh, to[n]);
        }
      }
      for (int n = 0; n < kCount; ++n) {
        for (int p = 1; p < kPlanes; ++p) {
          a[0][n] = hn::Add(a[0][n], a[p][n]);
          b[0][n] = hn::Add(b[0][n], b[p][n]);
        }
        hn::Store(a[0][n], d, out[n] + i);
        hn::Store(b[0][n], d, out[n] + kStrip + i);
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

  // Two rows by four vectors of sums, in registers: chains of additions enough to hide their latency.
  static constexpr int kPair = 2, kVectors = 4;
  using Sums = VF[kPair][kVectors];

  // Adds one octave. Rows between the same lines (kShared) share the loads of these.
  template <bool kShared>
  HWY_INLINE void addOctave(const RowPlace& first, const RowPlace& second, int i, Sums& n) const {
    const Floats d;
    const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
    for (int k = 0; k < 4; ++k) {
      const float* HWY_RESTRICT line0 = lines_ + first.lines[k / 2] + (k % 2) * kStrip + i;
      const float* HWY_RESTRICT line1 = lines_ + second.lines[k / 2] + (k % 2) * kStrip + i;
      const auto w0 = hn::Set(d, first.weights[k]), w1 = hn::Set(d, second.weights[k]);
      for (int v = 0; v < kVectors; ++v) {
        const auto x0 = hn::Load(d, line0 + v * lanes);
        const auto x1 = kShared ? x0 : hn::Load(d, line1 + v * lanes);
        n[0][v] = hn::MulAdd(w0, x0, n[0][v]);
        n[1][v] = hn::MulAdd(w1, x1, n[1][v]);
      }
    }
  }

  static HWY_INLINE void setAll(Sums& n, VF value) {
    for (auto& row : n)
      for (auto& v : row) v = value;
  }

  template <Fractal kFractal>
  HWY_INLINE void sum(int first, int terms, const RowPlace* places, int rows, float* HWY_RESTRICT out) const {
    const Floats d;
    const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
    const int width = width_;
    for (int r = 0; r < rows;
         r += kPair, places += std::ptrdiff_t{kPair} * tables_.terms, out += kPair * kStrip) {
      // A last row alone is its own partner; the chunk has room for what that gives.
      const RowPlace* partner = r + 1 < rows ? places + tables_.terms : places;
      for (int i = 0; i < width; i += kVectors * static_cast<int>(lanes)) {
        Sums s;
        setAll(s, hn::Set(d, tables_.bias));
        for (int t = 0; t < terms; ++t) {
          const bool shared =
              places[t].lines[0] == partner[t].lines[0] && places[t].lines[1] == partner[t].lines[1];
          if constexpr (kFractal == Fractal::kFbm) {
            if (shared)
              addOctave<true>(places[t], partner[t], i, s);
            else
              addOctave<false>(places[t], partner[t], i, s);
          } else {
            Sums n;
            setAll(n, hn::Zero(d));
            addOctave<false>(places[t], partner[t], i, n);
            for (int row = 0; row < kPair; ++row)
              for (int v = 0; v < kVectors; ++v)
                s[row][v] = shaped<kFractal>(n[row][v], s[row][v], tables_.term[first + t].weight);
          }
        }
        for (int row = 0; row < kPair; ++row)
          for (int v = 0; v < kVectors; ++v)
            hn::Store(s[row][v], d, out + static_cast<std::ptrdiff_t>(row) * kStrip + i + v * lanes);
      }
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
