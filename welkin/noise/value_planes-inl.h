// SPDX-License-Identifier: Apache-2.0
// Planes of lattice points of value noise under a strip of rows, hashed and smoothed. Compiled for every
// instruction set.
#if defined(WELKIN_NOISE_VALUE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_VALUE_PLANES_INL_H_
#undef WELKIN_NOISE_VALUE_PLANES_INL_H_
#else
#define WELKIN_NOISE_VALUE_PLANES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "welkin/core/random.h"
#include "welkin/noise/fill.h"
#include "welkin/noise/value_hash.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_AVX3
// ownPoint() of kHalves vectors, side by side since each of its multiplications waits for the one before.
template <int kHalves, class D, class V = hn::Vec<D>>
HWY_INLINE void ownPointVectors(D d, const std::uint64_t* HWY_RESTRICT columns, std::uint64_t rest,
                                V (&x)[kHalves]) {
  const auto half = static_cast<int>(hn::Lanes(d));
  const auto a = hn::Set(d, kMixFactors[0]), b = hn::Set(d, kMixFactors[1]), factor = hn::Set(d, kHashFactor);
  const auto rests = hn::Set(d, rest);
  for (int c = 0; c < kHalves; ++c) x[c] = hn::Mul(hn::Xor(hn::LoadU(d, columns + c * half), rests), a);
  for (auto& v : x) v = hn::Mul(hn::Xor(v, hn::ShiftRight<27>(v)), b);
  for (auto& v : x) v = hn::Mul(hn::Xor(v, hn::ShiftRight<31>(v)), factor);
}

// The project's own hash of kVectors vectors of points.
template <int kVectors, class T>
HWY_INLINE void ownHashVectors(const std::uint64_t* HWY_RESTRICT columns, const OwnRow& row,
                               T* HWY_RESTRICT out) {
  const hn::ScalableTag<std::uint64_t> d;
  const hn::Repartition<std::int32_t, decltype(d)> di;
  const hn::Repartition<float, decltype(d)> df;
  const auto half = static_cast<int>(hn::Lanes(d));
  const auto a = hn::Set(d, kMixFactors[0]), b = hn::Set(d, kMixFactors[1]);
  const auto first = hn::Set(d, row.first);
  constexpr int kHalves = 2 * kVectors;
  hn::Vec<decltype(d)> x[kHalves];
  ownPointVectors(d, columns, row.rest, x);
  for (auto& v : x) v = hn::Mul(hn::Xor3(first, v, hn::ShiftRight<30>(v)), a);
  for (auto& v : x) v = hn::Mul(hn::Xor(v, hn::ShiftRight<27>(v)), b);
  // The upper 24 bits count, which the last step leaves as they are.
  for (auto& v : x) v = hn::ShiftRight<40>(v);
  for (int c = 0; c < kHalves; c += 2) {
    const auto both = hn::ConcatEven(di, hn::BitCast(di, x[c + 1]), hn::BitCast(di, x[c]));
    const auto steps = hn::Sub(both, hn::Set(di, kOwnHalf));
    if constexpr (std::is_integral_v<T>)
      hn::StoreU(steps, di, out + c * half);
    else
      hn::StoreU(hn::Mul(hn::ConvertTo(df, steps), hn::Set(df, kOwnStep)), df, out + c * half);
  }
}

// The same at a time: hashes of kTaps whole times, which share what is known of the points, interpolated.
template <int kVectors, int kTaps>
HWY_INLINE void timedHashVectors(const std::uint64_t* HWY_RESTRICT columns, std::uint64_t rest,
                                 const ValueTables& octave, float* HWY_RESTRICT out) {
  const hn::ScalableTag<std::uint64_t> d;
  const hn::Repartition<std::int32_t, decltype(d)> di;
  const hn::Repartition<float, decltype(d)> df;
  static_assert(hn::MaxLanes(df) == kTimePhases);
  const auto a = hn::Set(d, kMixFactors[0]), b = hn::Set(d, kMixFactors[1]);
  const auto later = hn::Set(d, static_cast<std::uint64_t>(octave.clock->later));
  constexpr int kHalves = 2 * kVectors;
  hn::Vec<decltype(d)> x[kHalves], phase[kHalves];
  ownPointVectors(d, columns, rest, x);
  for (int c = 0; c < kHalves; ++c) phase[c] = hn::ShiftRight<60>(x[c]);
  for (auto& v : x) v = hn::Xor(v, hn::ShiftRight<30>(v));
  const auto together = [di](const auto* v) HWY_ATTR {
    return hn::ConcatEven(di, hn::BitCast(di, v[1]), hn::BitCast(di, v[0]));
  };
  hn::Vec<decltype(df)> sum[kVectors];
  for (int t = 0; t < kTaps; ++t) {
    const auto before = hn::Set(d, octave.clock->first[t]), after = hn::Set(d, octave.clock->first[t + 1]);
    const auto weights = hn::LoadU(df, octave.timeWeight[t]);
    hn::Vec<decltype(d)> h[kHalves];
    for (int c = 0; c < kHalves; ++c)
      h[c] = hn::Mul(hn::Xor(x[c], hn::IfThenElse(hn::Lt(phase[c], later), before, after)), a);
    for (auto& v : h) v = hn::Mul(hn::Xor(v, hn::ShiftRight<27>(v)), b);
    for (auto& v : h) v = hn::ShiftRight<40>(v);
    for (int k = 0; k < kVectors; ++k) {
      const auto steps = hn::ConvertTo(df, hn::Sub(together(h + 2 * k), hn::Set(di, kOwnHalf)));
      const auto weight = hn::TableLookupLanes(weights, hn::IndicesFromVec(df, together(phase + 2 * k)));
      sum[k] = t == 0 ? hn::Mul(weight, steps) : hn::Add(sum[k], hn::Mul(weight, steps));
    }
  }
  for (int k = 0; k < kVectors; ++k) hn::StoreU(sum[k], df, out + k * static_cast<int>(hn::Lanes(df)));
}
#endif

// Hashes of a row of points: the project's own as floats or in kOwnStep. Whole vectors are read and written.
template <class T>
void ownHashes(const std::uint64_t* HWY_RESTRICT columns, int count, const OwnRow& row, T* HWY_RESTRICT out) {
#if HWY_TARGET == HWY_AVX3  // the others have no multiplication of 64 bits: compilers do as well
  const auto lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
  int i = 0;
  for (; i + lanes < count; i += 2 * lanes) ownHashVectors<2>(columns + i, row, out + i);
  if (i < count) ownHashVectors<1>(columns + i, row, out + i);
#else
  const OwnRow of = row;
  for (int i = 0; i < count; ++i) {
    if constexpr (std::is_integral_v<T>)
      out[i] = ownSteps(columns[i], of);
    else
      out[i] = ownHash(columns[i], of);
  }
#endif
}
// The same at the octave's time, of the project's own hash.
template <int kTaps>
void timedHashes(const std::uint64_t* HWY_RESTRICT columns, int count, std::uint64_t rest,
                 const ValueTables& octave, float* HWY_RESTRICT out) {
#if HWY_TARGET == HWY_AVX3
  const auto lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
  int i = 0;
  for (; i + lanes < count; i += 2 * lanes) timedHashVectors<2, kTaps>(columns + i, rest, octave, out + i);
  if (i < count) timedHashVectors<1, kTaps>(columns + i, rest, octave, out + i);
#else
  const int later = octave.clock->later;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t point = ownPoint(columns[i], rest);
    const int phase = timePhase(point);
    const std::uint64_t* const first = octave.clock->first.data() + (phase >= later ? 1 : 0);
    const auto part = [&](int t) {
      return octave.timeWeight[t][phase] * static_cast<float>(ownSteps(first[t], point));
    };
    float sum = part(0);
    for (int t = 1; t < kTaps; ++t) sum += part(t);
    out[i] = sum;
  }
#endif
}
inline void sourceHashes(const std::uint32_t* HWY_RESTRICT x, int count, std::uint32_t row,
                         float* HWY_RESTRICT out) {
  for (int i = 0; i < count; ++i) out[i] = sourceHash(x[i] + row);
}

// The sums over 3 x 3 points around each of a row but the first and the last, of hashes in kOwnStep or of
// any in doubles; rows lie `stride` apart. `columns` is room for a row.
template <class T, class Sum>
void sumBoxes(const T* HWY_RESTRICT row, std::ptrdiff_t stride, int count, Sum* HWY_RESTRICT columns,
              Sum* HWY_RESTRICT out) {
  const T *above = row - stride, *below = row + stride;
  for (int i = 0; i < count; ++i)
    columns[i] = static_cast<Sum>(above[i]) + static_cast<Sum>(row[i]) + static_cast<Sum>(below[i]);
  for (int i = 1; i + 1 < count; ++i) out[i] = columns[i - 1] + columns[i] + columns[i + 1];
}

// Averages over 27 points for a row but its first and last: of the planes below, here and above, the hashes
// and what sumBoxes() made of them.
template <class T>
using Three = const T* const (&)[3];
inline void smoothRow(Three<float> hash, Three<double> box, std::ptrdiff_t stride, int count,
                      float* HWY_RESTRICT out) {
  const float *below = hash[0], *here = hash[1], *above = hash[2];
  for (int i = 1; i + 1 < count; ++i) {
    const auto at = [](const float* v) { return static_cast<double>(*v); };
    const double faces = at(below + i) + at(here + i - stride) + at(here + i - 1) + at(here + i + 1) +
                         at(here + i + stride) + at(above + i);
    out[i] = smoothedValue(box[0][i] + box[1][i] + box[2][i], faces, here[i]);
  }
}
inline void smoothRow(Three<std::int32_t> hash, Three<std::int32_t> box, std::ptrdiff_t stride, int count,
                      float* HWY_RESTRICT out) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const hn::Rebind<float, decltype(d)> df;
  // Steps are a power of two: in the weights they round as in the values.
  const auto kRests = hn::Set(d, kRest * kOwnStep), kFaces = hn::Set(d, kFace * kOwnStep),
             kCentres = hn::Set(d, kCentre * kOwnStep);
  const std::int32_t *HWY_RESTRICT below = hash[0], *HWY_RESTRICT here = hash[1],
                                   *HWY_RESTRICT above = hash[2];
  const auto load = [di](const std::int32_t* v) HWY_ATTR { return hn::LoadU(di, v); };
  for (int i = 1; i + 1 < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto centre = load(here + i);
    const auto faces = hn::Add(
        hn::Add(hn::Add(load(below + i), load(above + i)), hn::Add(load(here + i - 1), load(here + i + 1))),
        hn::Add(load(here + i - stride), load(here + i + stride)));
    const auto cube = hn::Add(hn::Add(load(box[0] + i), load(box[1] + i)), load(box[2] + i));
    const auto rest = hn::Sub(hn::Sub(cube, faces), centre);
    const auto sum =
        hn::Add(hn::Add(hn::Mul(kRests, hn::PromoteTo(d, rest)), hn::Mul(kFaces, hn::PromoteTo(d, faces))),
                hn::Mul(kCentres, hn::PromoteTo(d, centre)));
    hn::StoreU(hn::DemoteTo(df, sum), df, out + i);
  }
}

// What of the lattice lies under a strip of rows. Planes in use are kept.
class ValuePlanes {
 public:
  // Of the octave's lines along x and y, so many points from `firstX` and `firstY` on.
  ValuePlanes(const ValueTables& octave, int firstX, int points, int firstY, int rows, Scratch& scratch)
      : octave_(&octave), firstX_(firstX), points_(points), firstY_(firstY), rows_(rows) {
    const std::size_t size = static_cast<std::size_t>(stride()) * rows;
    for (int t = 0; t < octave.taps; ++t) values_[t] = {-1, scratch.take<float>(size)};
    if (!octave.settings.smooth) return;
    if (octave.clock != nullptr) {
      timed_ = scratch.take<float>(static_cast<std::size_t>(stride()));
      std::fill_n(timed_, stride(), 0.0f);
    }
    if (octave.settings.seed == 0)
      take(scratch, size, source_);
    else
      take(scratch, size, own_);
  }

  // Floats of a row of points that matter, from its first, and from one row to the next. Vectors may be read
  // over the former.
  std::ptrdiff_t length() const { return (points_ + kVector - 1) / kVector * kVector; }
  std::ptrdiff_t stride() const { return length() + 2 * kVector; }
  int rows() const { return rows_; }
  // Rows on either side that are there for others to be smoothed.
  int margin() const { return octave_->settings.smooth ? 1 : 0; }

  // What is interpolated, of point `k` of the octave's line along z; asked for in rising order, up to a step
  // back of as many planes as there are taps. Margins are undefined.
  const float* at(int k) {
    Plane<float>& plane = values_[k % octave_->taps];
    if (plane.k == k) return plane.at;
    plane.k = k;
    const bool source = octave_->settings.seed == 0;
    if (!octave_->settings.smooth)
      hashPlane(k, plane.at);
    else if (source)
      smooth(k, source_, plane.at);
    else
      smooth(k, own_, plane.at);
    return plane.at;
  }

 private:
  static constexpr int kVector = 16;  // floats of the longest

  template <class T>
  struct Plane {
    int k;  // -1: none
    T* at;
  };
  // Planes to be smoothed: hashes and sums over 3 x 3 of them.
  template <class T, class Sum>
  struct Bare {
    Plane<T> hash[3];
    Sum *box[3], *columns;
  };

  template <class T, class Sum>
  void take(Scratch& scratch, std::size_t size, Bare<T, Sum>& bare) const {
    for (int i = 0; i < 3; ++i) {
      bare.hash[i] = {-1, scratch.take<T>(size)};
      bare.box[i] = scratch.take<Sum>(size);
    }
    bare.columns = scratch.take<Sum>(static_cast<std::size_t>(stride()));
  }

  template <class T>
  void hashPlane(int k, T* out) const {
    const std::uint32_t z = octave_->axis[2].index[k];
    const ValueLine& x = octave_->axis[0];
    const std::uint64_t seed = octave_->settings.seed;
    for (int r = 0; r < rows_; ++r, out += stride()) {
      const std::uint32_t y = octave_->axis[1].index[firstY_ + r];
      if (octave_->clock != nullptr) {
        hashRowInTime(ownRow(seed, y, z), out);
      } else if (std::is_same_v<T, std::int32_t> || seed != 0) {
        ownHashes(x.column + firstX_, points_, ownRow(seed, y, z), out);
      } else {
        if constexpr (std::is_same_v<T, float>)
          sourceHashes(x.index + firstX_, points_, sourceRow(y, z), out);
      }
    }
  }

  void hashRowInTime(const OwnRow& row, float* out) const {
    const std::uint64_t* const columns = octave_->axis[0].column + firstX_;
    if (octave_->taps == 2)
      timedHashes<2>(columns, points_, row.rest, *octave_, out);
    else
      timedHashes<4>(columns, points_, row.rest, *octave_, out);
  }
  // To the nearest step, so that they are smoothed as at no time.
  void hashRowInTime(const OwnRow& row, std::int32_t* out) const {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    hashRowInTime(row, timed_);
    for (int i = 0; i < points_; i += static_cast<int>(hn::Lanes(d)))
      hn::Store(hn::NearestInt(hn::Mul(hn::Load(d, timed_ + i), hn::Set(d, 1.0f / kOwnStep))), di, out + i);
  }

  template <class T, class Sum>
  void smooth(int k, Bare<T, Sum>& bare, float* out) const {
    const T* hash[3];
    const Sum* box[3];
    for (int i = 0; i < 3; ++i) {
      const int slot = (k + i - 1) % 3;
      Plane<T>& plane = bare.hash[slot];
      if (plane.k != k + i - 1) {
        plane.k = k + i - 1;
        hashPlane(plane.k, plane.at);
        for (int r = 1; r + 1 < rows_; ++r)
          sumBoxes(plane.at + stride() * r, stride(), points_, bare.columns, bare.box[slot] + stride() * r);
      }
      hash[i] = plane.at;
      box[i] = bare.box[slot];
    }
    for (int r = 1; r + 1 < rows_; ++r) {
      const std::ptrdiff_t at = stride() * r;
      smoothRow({hash[0] + at, hash[1] + at, hash[2] + at}, {box[0] + at, box[1] + at, box[2] + at}, stride(),
                points_, out + at);
    }
  }

  const ValueTables* octave_;
  int firstX_, points_, firstY_, rows_;
  Plane<float> values_[4];
  float* timed_ = nullptr;  // a row
  union {                   // by whose hash it is
    Bare<std::int32_t, std::int32_t> own_;
    Bare<float, double> source_;
  };
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
