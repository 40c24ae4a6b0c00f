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
#include "welkin/noise/gradient_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A strip of the box, chunk after chunk of rows.
class GradientRows {
 public:
  GradientRows(const GradientTables& tables, Scratch& scratch, int x, int width)
      : tables_(tables), x_(x), width_(padded(width)) {
    const auto terms = static_cast<std::size_t>(tables.terms);
    sliceStride_ = static_cast<std::ptrdiff_t>(tables.lines) * lineStride(tables.strip);
    lines_ = scratch.take<float>(static_cast<std::size_t>(sliceStride_ * tables.slices));
    planes_ = scratch.take<Plane>(kPlanesOfTerm * terms);
    shared_ = scratch.take<SharedPlanes>(terms);
    points_ = scratch.take<float>(std::size_t{kSideBySide} * kPointValues * kPointStride);
    below_ = scratch.take<std::int32_t>(terms * kStrip);
    for (int t = 0; t < tables.terms; ++t)
      if (tables.term[t].x.pointHash != nullptr)
        makeBelow(tables.term[t].x.cell + x, below_ + std::ptrdiff_t{kStrip} * t);
    if (tables.published) published_ = scratch.take<std::uint32_t>(std::size_t{4} * kMostLines * kStrip);
  }

  // Slices from z on, at most as many as tables.slices, are worked on together from here on.
  void beginSlices(int z, int count) {
    slices_ = count;
    for (int t = 0; t < tables_.terms; ++t) {
      for (int s = 0; s < count; ++s) makePlanes(t, z + s, planesOf(t, s));
      shared_[t] = count == 2 ? sharedPlanes(t) : SharedPlanes::kNone;
    }
    fresh_ = true;
  }

  // The rows of every sum from y on that are in the same chunk, at most `rows`; returns their number. The
  // samples from i on of row r of sum s go to sinkOf(slice, s)(r, i, vectors), kVectors at a time; the last
  // ones may be past the width. Chunks of a slice must follow one another.
  template <class SinkOf>
  HWY_INLINE int fillChunkInto(int y, int rows, const SinkOf& sinkOf) {
    rows = expandChunk(y, rows);
    for (int slice = 0; slice < slices_; ++slice) sumSlice(slice, y, rows, sinkOf);
    return rows;
  }

  // The rows of a chunk of one slice, whose lines are made.
  template <class SinkOf>
  HWY_NOINLINE void sumSlice(int slice, int y, int rows, const SinkOf& sinkOf) const {
    for (int s = 0; s < tables_.sums; ++s) {
      const int first = tables_.first[s], terms = tables_.first[s + 1] - first;
      const SumOf of{first, terms, rows, lines_ + slice * sliceStride_,
                     tables_.rows + static_cast<std::ptrdiff_t>(y) * tables_.terms + first};
      const auto sink = sinkOf(slice, s);
      switch (tables_.fractal) {
        case Fractal::kFbm:
          if (terms == 1)
            sumOne(of, sink);
          else
            sum<Fractal::kFbm>(of, sink);
          break;
        case Fractal::kBillow:
          sum<Fractal::kBillow>(of, sink);
          break;
        case Fractal::kRidged:
          sum<Fractal::kRidged>(of, sink);
          break;
      }
    }
  }

  // Row r of sum s of the one slice goes to out[s] + r * strip.
  HWY_NOINLINE int fillChunk(int y, int rows, float* const* out) {
    return fillChunkInto(y, rows, [out, strip = tables_.strip](int, int s) HWY_ATTR {
      float* HWY_RESTRICT to = out[s];
      return [to, strip](int row, int i, const VF* v) HWY_ATTR {
        const Floats d;
        float* HWY_RESTRICT out = to + static_cast<std::ptrdiff_t>(row) * strip + i;
        for (int k = 0; k < kVectors; ++k) hn::Store(v[k], d, out + k * static_cast<int>(hn::Lanes(d)));
      };
    });
  }

 private:
  static constexpr std::size_t kPlanesOfTerm = kMaxPlanes * kMostSlices;
  // A strip has as many points as samples and two, and vectors may reach over the last.
  static constexpr int kSideBySide = 8, kPointValues = 3, kPointStride = kStrip + kPad;

  // From the point below each vector's first sample to those below all of its samples.
  void makeBelow(const std::int32_t* HWY_RESTRICT cell, std::int32_t* HWY_RESTRICT below) const {
    const hn::RebindToSigned<Floats> di;
    for (int i = 0; i < width_; i += static_cast<int>(hn::Lanes(di)))
      hn::Store(hn::Sub(hn::LoadU(di, cell + i), hn::Set(di, cell[i])), di, below + i);
  }

  // Lines that are not left from the chunk before.
  struct NewLines {
    const LineRef* line;
    const std::uint32_t* hash;
    int count;
  };

  // Makes the lines of the chunk that row y is in; returns how many rows, at most `rows`, follow in it.
  int expandChunk(int y, int rows) {
    const int chunk = (y + tables_.lead) / tables_.chunk;
    const ChunkLines* lines = tables_.chunks + static_cast<std::ptrdiff_t>(chunk) * tables_.terms;
    for (int t = 0; t < tables_.terms; ++t) {
      const std::uint32_t left = fresh_ ? 0 : lines[t].left;
      if (left < lines[t].count)
        expand(t, {lines[t].line + left, lines[t].hash + left, static_cast<int>(lines[t].count - left)});
    }
    fresh_ = false;
    return HWY_MIN(rows, (chunk + 1) * tables_.chunk - tables_.lead - y);
  }

  // Which planes of lattice points two slices share.
  enum class SharedPlanes : std::uint8_t {
    kNone,
    kBoth,
    kNext
  };  // kNext: the first's upper is the second's lower

  Plane* planesOf(int t, int slice) const { return planes_ + kPlanesOfTerm * t + kMaxPlanes * slice; }

  SharedPlanes sharedPlanes(int t) const {
    const GradientLattice& lattice = *tables_.term[t].lattice;
    if (lattice.axes() != 3 || lattice.published()) return SharedPlanes::kNone;
    const Plane *first = planesOf(t, 0), *second = planesOf(t, 1);
    if (first[0].index == second[0].index && first[1].index == second[1].index) return SharedPlanes::kBoth;
    return first[1].index == second[0].index ? SharedPlanes::kNext : SharedPlanes::kNone;
  }

  void makePlanes(int t, int z, Plane* planes) const {
    const TermTables& term = tables_.term[t];
    const Place outer[2] = {term.z != nullptr ? term.z[z] : term.time, term.time};
    const int axes = term.lattice->axes();
    for (int p = 0; p < 1 << (axes - 2); ++p) {
      Plane& plane = planes[p];
      plane = {0, 0, 1.0f, {1.0f, 1.0f}};
      for (int e = 2; e < axes; ++e) {
        const bool high = (p >> (e - 2) & 1) != 0;
        const Corner& corner = high ? outer[e - 2].high : outer[e - 2].low;
        const std::uint32_t index = high ? outer[e - 2].highIndex : outer[e - 2].lowIndex;
        if (e == 2) plane.index = index;
        plane.hash += term.lattice->axis(e).hash(index);
        plane.weight *= corner.weight;
        for (int i = 0; i < 2; ++i) plane.reach[i] *= i + 2 == e ? corner.reach : corner.weight;
      }
    }
  }

  void expand(int t, const NewLines& made) {
    if (shared_[t] == SharedPlanes::kBoth) return expandLines<3, 2, 0>(t, 0, made);
    if (shared_[t] == SharedPlanes::kNext) return expandLines<3, 2, 1>(t, 0, made);
    for (int slice = 0; slice < slices_; ++slice) switch (tables_.term[t].lattice->axes()) {
        case 2:
          expandLines<2, 1, 0>(t, slice, made);
          break;
        case 3:
          expandLines<3, 1, 0>(t, slice, made);
          break;
        default:
          expandLines<4, 1, 0>(t, slice, made);
          break;
      }
  }

  // In the slices from `slice` on, kSlices of them (Points says what kShift is).
  template <int kAxes, int kSlices, int kShift>
  HWY_NOINLINE void expandLines(int t, int slice, const NewLines& made) {
    using P = Points<kAxes, kSlices, kShift>;
    const Words du;
    const TermTables& term = tables_.term[t];
    const Plane* planes = planesOf(t, slice);
    HWY_ALIGN std::uint32_t rows[P::kDistinct][padded(kMostLines)];
    const Plane* plane[P::kDistinct];
    for (int p = 0; p < P::kDistinct; ++p)
      plane[p] = p < P::kPlanes ? planes + p : planes + kMaxPlanes + (p - kShift);
    for (int p = 0; p < P::kDistinct; ++p)
      for (int n = 0; n < made.count; n += static_cast<int>(hn::Lanes(du))) {
        const auto sum = hn::Add(hn::LoadU(du, made.hash + n), hn::Set(du, plane[p]->hash));
        hn::Store(hn::Or(mixedWords(sum), hn::Set(du, 1u)), du, rows[p] + n);
      }
    Hashes hash{};  // stays so where points are gathered: they have hashes of their own
    if (term.x.lowHash != nullptr) hash = {term.x.lowHash + x_, term.x.highHash + x_, 0, 0};
    if (term.lattice->published()) {
      hash = {published_, published_ + kStrip, std::ptrdiff_t{2} * kStrip * P::kDistinct,
              std::ptrdiff_t{2} * kStrip};
      for (int n = 0; n < made.count; ++n)
        for (int p = 0; p < P::kDistinct; ++p) {
          publishedHashes(term, made.line[n].index, plane[p]->index,
                          published_ + n * hash.line + p * hash.plane);
          rows[p][n] = 1;
        }
    }
    const P points(planes);
    // With two axes an evaluation costs no more than what gathering adds.
    const bool gathered = kAxes > 2 && term.x.pointHash != nullptr && gathers(term.x.step);
    float* const to = lines_ + slice * sliceStride_;
    // Lines side by side share the loads of factors, and short ones wait less for what has just been stored.
    constexpr int kGathered = kSlices == 1 ? 3 : 2, kShort = kSideBySide / kSlices, kScattered = 2 / kSlices;
    for (int n = 0; n < made.count;) {
      const Side side{made.line + n, &rows[0][n], to};
      const int left = made.count - n;
      if (gathered)
        n += width_ > kNarrow ? gatherSome<kGathered>(points, t, side, left)
                              : gatherSome<kShort>(points, t, side, left);
      else
        n += scatterSome<kScattered>(points, term.x, hash, n, side, left);
    }
  }

  // Whether all lattice points beside a vector of samples are in one vector of points, for any rounding of
  // places that lie on lattice points.
  static bool gathers(double step) {
    const auto lanes = static_cast<int>(hn::Lanes(Floats()));
    return (lanes - 1) * step < lanes - 2 - 1e-6;
  }

  // By sample, the hashes' factors of the points below and above; distances between lines' and planes' own.
  struct Hashes {
    const std::uint32_t *low, *high;
    std::ptrdiff_t line, plane;
  };

  // Lines side by side: factors of their hashes by plane, and where the first slice's lie.
  struct Side {
    const LineRef* lines;
    const std::uint32_t* rows;
    float* to;
  };

  // At most kCount of `left` lines; returns how many.
  template <int kCount, class P>
  HWY_INLINE int gatherSome(const P& points, int t, const Side& side, int left) const {
    if constexpr (kCount > 1)
      if (left < kCount) return gatherSome<kCount - 1>(points, t, side, left);
    gather<kCount>(points, t, side);
    return kCount;
  }
  template <int kCount, class P>
  HWY_INLINE int scatterSome(const P& points, const RowPlaces& x, Hashes hash, int n, const Side& side,
                             int left) const {
    if constexpr (kCount > 1)
      if (left < kCount) return scatterSome<kCount - 1>(points, x, hash, n, side, left);
    hash.low += n * hash.line;
    hash.high += n * hash.line;
    scatter<kCount>(points, x, hash, side);
    return kCount;
  }

  // Lines whose points are evaluated for every sample.
  template <int kCount, int kAxes, int kSlices, int kShift>
  HWY_INLINE void scatter(const Points<kAxes, kSlices, kShift>& points, const RowPlaces& x,
                          const Hashes& hash, const Side& side) const {
    using P = Points<kAxes, kSlices, kShift>;
    const Words du;
    VU row[P::kDistinct][kCount];
    for (int n = 0; n < kCount; ++n)
      for (int p = 0; p < P::kDistinct; ++p) row[p][n] = hn::Set(du, side.rows[p * padded(kMostLines) + n]);
    const auto nothing = [](int) { return 0; };
    expandSome<kAxes, kCount, kSlices>(
        x, side, nothing, [&, hash](int, int n, int i, const auto& put) HWY_ATTR {
          const auto hashOf = [&](const std::uint32_t* from) HWY_ATTR {
            return [&, from](int p) HWY_ATTR {
              return hn::Mul(hn::LoadU(du, from + n * hash.line + p * hash.plane + i), row[p][n]);
            };
          };
          PointValue value[kSlices];
          Half half[kSlices];
          points(hashOf(hash.low), value);
          for (int s = 0; s < kSlices; ++s) half[s] = put.low(value[s]);
          points(hashOf(hash.high), value);
          for (int s = 0; s < kSlices; ++s) put.high(s, half[s], value[s]);
        });
  }

  // Lines whose points are evaluated first, each once.
  template <int kCount, int kAxes, int kSlices, int kShift>
  HWY_INLINE void gather(const Points<kAxes, kSlices, kShift>& points, int t, const Side& side) const {
    const Floats d;
    const Words du;
    const RowPlaces& x = tables_.term[t].x;
    const std::int32_t* HWY_RESTRICT cell = x.cell + x_;
    const std::uint32_t* HWY_RESTRICT hash = x.pointHash + cell[0];
    const int count = cell[width_ - 1] - cell[0] + 2;
    for (int n = 0; n < kCount; ++n) {
      float* HWY_RESTRICT to = points_ + std::ptrdiff_t{n} * kSlices * kPointValues * kPointStride;
      for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
        const VU h = hn::LoadU(du, hash + i);
        PointValue v[kSlices];
        points([&](int p) HWY_ATTR { return hn::Mul(h, hn::Set(du, side.rows[p * padded(kMostLines) + n])); },
               v);
        for (int s = 0; s < kSlices; ++s) {
          float* HWY_RESTRICT const at = to + std::ptrdiff_t{s} * kPointValues * kPointStride + i;
          if constexpr (kAxes > 2) hn::Store(v[s].level, d, at);
          hn::Store(v[s].slope, d, at + kPointStride);
          hn::Store(v[s].b, d, at + 2 * kPointStride);
        }
      }
    }
    const hn::RebindToSigned<Floats> di;
    using Indices = decltype(hn::IndicesFromVec(d, hn::Zero(di)));
    struct Places {
      Indices below, above;
      std::ptrdiff_t base;
    };
    const float* HWY_RESTRICT const from = points_;
    const std::int32_t begin = cell[0];
    const std::int32_t* HWY_RESTRICT const below = below_ + std::ptrdiff_t{kStrip} * t;
    const auto placesOf = [=](int i) HWY_ATTR {
      const auto at = hn::Load(di, below + i);
      return Places{hn::IndicesFromVec(d, at), hn::IndicesFromVec(d, hn::Add(at, hn::Set(di, 1))),
                    cell[i] - begin};
    };
    const auto pointsOf = [=](const Places& places, int n, int, const auto& put) HWY_ATTR {
      for (int s = 0; s < kSlices; ++s) {
        PointValue low, high;
        const auto spread = [&](int value, VF& atLow, VF& atHigh) HWY_ATTR {
          const std::ptrdiff_t which = (std::ptrdiff_t{n} * kSlices + s) * kPointValues + value;
          VF v = hn::LoadU(d, from + which * kPointStride + places.base);
          keep(v);
          atLow = hn::TableLookupLanes(v, places.below);
          atHigh = hn::TableLookupLanes(v, places.above);
        };
        if constexpr (kAxes > 2) spread(0, low.level, high.level);
        spread(1, low.slope, high.slope);
        spread(2, low.b, high.b);
        put.high(s, put.low(low), high);
      }
    };
    expandSome<kAxes, kCount, kSlices>(x, side, placesOf, pointsOf);
  }

  // A and B of the points below samples, and of both when those above are added.
  struct Half {
    VF a, b;
  };
  template <int kAxes>
  struct Put {
    VF lowWeight, lowReach, highWeight, highReach;
    std::ptrdiff_t at;
    float* const* out;  // by slice

    HWY_INLINE Half low(const PointValue& v) const {
      VF a = hn::Mul(lowReach, v.slope);
      if constexpr (kAxes > 2) a = hn::MulAdd(lowWeight, v.level, a);
      return {a, hn::Mul(lowWeight, v.b)};
    }
    HWY_INLINE void high(int slice, const Half& half, const PointValue& v) const {
      const Floats d;
      VF a = hn::MulAdd(highReach, v.slope, half.a);
      if constexpr (kAxes > 2) a = hn::MulAdd(highWeight, v.level, a);
      hn::Store(a, d, out[slice] + at);
      hn::Store(hn::MulAdd(highWeight, v.b, half.b), d, out[slice] + at + kPad);
    }
  };

  // pointsOf(placesOf(i), n, i, put) puts line n's points on either side of the samples from i on, by slice.
  template <int kAxes, int kCount, int kSlices, class PlacesOf, class PointsOf>
  HWY_INLINE void expandSome(const RowPlaces& x, const Side& side, const PlacesOf& placesOf,
                             const PointsOf& pointsOf) const {
    const Floats d;
    float* out[kCount][kSlices];
    for (int n = 0; n < kCount; ++n)
      for (int s = 0; s < kSlices; ++s) out[n][s] = side.to + side.lines[n].offset + s * sliceStride_;
    // What is stored might, for all that the compiler knows, be these.
    const float* HWY_RESTRICT const lowWeights = x.lowWeight + x_;
    const float* HWY_RESTRICT const highWeights = x.highWeight + x_;
    const float* HWY_RESTRICT const lowReaches = x.lowReach + x_;
    const float* HWY_RESTRICT const highReaches = x.highReach + x_;
    const int width = width_;
    for (int i = 0; i < width; i += static_cast<int>(hn::Lanes(d))) {
      const auto lowWeight = hn::LoadU(d, lowWeights + i), highWeight = hn::LoadU(d, highWeights + i);
      const auto lowReach = hn::LoadU(d, lowReaches + i), highReach = hn::LoadU(d, highReaches + i);
      const auto places = placesOf(i);
      for (int n = 0; n < kCount; ++n)
        pointsOf(places, n, i, Put<kAxes>{lowWeight, lowReach, highWeight, highReach, inLine(i), out[n]});
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
  static constexpr int kPair = 2;
  using Sums = VF[kPair][kVectors];

  // Which lines a row shares with the row before, and need not be loaded again.
  enum class Shared { kNone, kBoth, kNext };  // kNext: its lower one is the other's upper one
  static Shared sharedBy(const RowPlace& first, const RowPlace& second) {
    if (first.lines[0] == second.lines[0] && first.lines[1] == second.lines[1]) return Shared::kBoth;
    return first.lines[1] == second.lines[0] ? Shared::kNext : Shared::kNone;
  }

  // Adds one octave; `lines` from the samples on.
  template <Shared kShared>
  static HWY_INLINE void addOctave(const float* HWY_RESTRICT lines, const RowPlace& first,
                                   const RowPlace& second, Sums& n) {
    const Floats d;
    const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
    const float* HWY_RESTRICT const line0[2] = {lines + first.lines[0], lines + first.lines[1]};
    const float* HWY_RESTRICT const line1[2] = {lines + second.lines[0], lines + second.lines[1]};
    // Unrolled by GCC, it would not fit the registers.
#pragma GCC unroll 1
    for (int part = 0; part < 2; ++part) {  // A, then B
      const VF low0 = hn::Set(d, first.weights[part]), high0 = hn::Set(d, first.weights[2 + part]);
      const VF low1 = hn::Set(d, second.weights[part]), high1 = hn::Set(d, second.weights[2 + part]);
      for (int v = 0; v < kVectors; ++v) {
        const std::ptrdiff_t at = part * kPad + v * lanes;
        VF x = hn::Load(d, line0[0] + at);
        if constexpr (kShared == Shared::kBoth) keep(x);
        n[0][v] = hn::MulAdd(low0, x, n[0][v]);
        if constexpr (kShared == Shared::kBoth) n[1][v] = hn::MulAdd(low1, x, n[1][v]);
        x = hn::Load(d, line0[1] + at);
        if constexpr (kShared != Shared::kNone) keep(x);
        n[0][v] = hn::MulAdd(high0, x, n[0][v]);
        if constexpr (kShared == Shared::kBoth) n[1][v] = hn::MulAdd(high1, x, n[1][v]);
        if constexpr (kShared == Shared::kNext) n[1][v] = hn::MulAdd(low1, x, n[1][v]);
        if constexpr (kShared == Shared::kNone)
          n[1][v] = hn::MulAdd(low1, hn::Load(d, line1[0] + at), n[1][v]);
        if constexpr (kShared != Shared::kBoth)
          n[1][v] = hn::MulAdd(high1, hn::Load(d, line1[1] + at), n[1][v]);
      }
    }
  }

  static HWY_INLINE void setAll(Sums& n, VF value) {
    for (auto& row : n)
      for (auto& v : row) v = value;
  }

  // What a sum is made of: terms, and rows between lines.
  struct SumOf {
    int first, terms, rows;
    const float* lines;
    const RowPlace* places;  // of the first term in the first row
  };

  // sink(row, i, v) takes the samples from i on of each row.
  template <Fractal kFractal, class Sink>
  HWY_INLINE void sum(const SumOf& of, const Sink& sink) const {
    const Floats d;
    const int first = of.first, terms = of.terms, rows = of.rows;
    const RowPlace* places = of.places;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    const int width = width_, stride = tables_.terms;
    const float* HWY_RESTRICT const lines = of.lines;
    const auto bias = hn::Set(d, tables_.bias);
    for (int r = 0; r < rows; r += kPair, places += std::ptrdiff_t{kPair} * stride) {
      // A last row alone is its own partner.
      const bool pair = r + 1 < rows;
      const RowPlace* partner = pair ? places + stride : places;
      for (int i = 0; i < width; i += kVectors * lanes) {
        Sums s;
        setAll(s, bias);
        for (int t = 0; t < terms; ++t) {
          if constexpr (kFractal == Fractal::kFbm) {
            switch (sharedBy(places[t], partner[t])) {
              case Shared::kBoth:
                addOctave<Shared::kBoth>(lines + inLine(i), places[t], partner[t], s);
                break;
              case Shared::kNext:
                addOctave<Shared::kNext>(lines + inLine(i), places[t], partner[t], s);
                break;
              case Shared::kNone:
                addOctave<Shared::kNone>(lines + inLine(i), places[t], partner[t], s);
                break;
            }
          } else {
            Sums n;
            setAll(n, hn::Zero(d));
            addOctave<Shared::kNone>(lines + inLine(i), places[t], partner[t], n);
            for (int row = 0; row < kPair; ++row)
              for (int v = 0; v < kVectors; ++v)
                s[row][v] = shaped<kFractal>(n[row][v], s[row][v], tables_.term[first + t].weight);
          }
        }
        sink(r, i, s[0]);
        if (pair) sink(r + 1, i, s[1]);
      }
    }
  }

  // The same of a single octave: its weights stay in registers.
  template <class Sink>
  HWY_INLINE void sumOne(const SumOf& of, const Sink& sink) const {
    const Floats d;
    const RowPlace* places = of.places;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    const int width = width_, stride = tables_.terms;
    const auto bias = hn::Set(d, tables_.bias);
    for (int r = 0; r < of.rows; ++r, places += stride) {
      const float* HWY_RESTRICT const low = of.lines + places->lines[0];
      const float* HWY_RESTRICT const high = of.lines + places->lines[1];
      const auto lowWeight = hn::Set(d, places->weights[0]), lowReach = hn::Set(d, places->weights[1]);
      const auto highWeight = hn::Set(d, places->weights[2]), highReach = hn::Set(d, places->weights[3]);
      for (int i = 0; i < width; i += kVectors * lanes) {
        VF s[kVectors];
        for (int v = 0; v < kVectors; ++v) {
          const int at = inLine(i) + v * lanes;
          s[v] = hn::MulAdd(lowWeight, hn::Load(d, low + at), bias);
          s[v] = hn::MulAdd(highWeight, hn::Load(d, high + at), s[v]);
          s[v] = hn::MulAdd(lowReach, hn::Load(d, low + kPad + at), s[v]);
          s[v] = hn::MulAdd(highReach, hn::Load(d, high + kPad + at), s[v]);
        }
        sink(r, i, s);
      }
    }
  }

  const GradientTables& tables_;
  int x_, width_;
  int slices_ = 1;
  bool fresh_ = true;                   // no lines are left
  float* lines_;                        // the octaves' rings, a slice after the other
  std::ptrdiff_t sliceStride_;          // floats
  Plane* planes_;                       // kMaxPlanes a slice, kMostSlices a term
  SharedPlanes* shared_;                // by term
  float* points_;                       // of kSideBySide lines, each value of PointValue
  std::int32_t* below_;                 // by sample, a term after the other
  std::uint32_t* published_ = nullptr;  // hashes: of a line, a plane, the lower corners, then the upper ones
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
