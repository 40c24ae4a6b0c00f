// SPDX-License-Identifier: Apache-2.0
// Rows of sums of value noise. Compiled for every instruction set.
//
// Planes of lattice points are hashed (and smoothed) once each, mixed along z for a slice of samples, then
// along y for each row, and spread over the samples along x: a vector of samples takes its points from one or
// two vectors of them by a shuffle. Nothing is fused and every sum has its own order, so that every set gives
// the same bits.
#if defined(WELKIN_NOISE_VALUE_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_VALUE_ROWS_INL_H_
#undef WELKIN_NOISE_VALUE_ROWS_INL_H_
#else
#define WELKIN_NOISE_VALUE_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "welkin/noise/fill.h"
#include "welkin/noise/format-inl.h"
#include "welkin/noise/value_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A strip of some rows of the box, slice by slice.
class ValueRows {
 public:
  // At most kStrip samples across.
  ValueRows(const ValueTables* octaves, int count, const Block& b, Scratch& scratch)
      : octaves_(octaves), count_(count), x_(b.x), y_(b.y), width_(b.width) {
    states_ = scratch.take<State>(static_cast<std::size_t>(count));
    std::ptrdiff_t row = 0;
    for (int o = 0; o < count; ++o) {
      setState(octaves[o], b, scratch, states_[o]);
      row = HWY_MAX(row, states_[o].planes.stride());
    }
    rowStride_ = row;
    rows_ = scratch.take<float>(static_cast<std::size_t>(row) * kRows);
  }

  void beginSlice(int z) {
    for (int o = 0; o < count_; ++o) {
      const ValueTables& octave = octaves_[o];
      State& s = states_[o];
      const ValueLine& line = octave.axis[2];
      Mix mix[4]{};
      int taps = 0;
      for (int t = 0; t < octave.taps; ++t) {  // in a plane all but one weigh nothing
        const float w = line.weight[t][z];
        if (w != 0.0f) mix[taps++] = {s.planes.at(line.first[z] + t), octave.weight * w};
      }
      const std::ptrdiff_t margin = s.planes.margin() * s.planes.stride();
      mixRows(taps, mix, margin, s.planes.stride() * s.planes.rows() - margin, s.slice);
    }
  }

  // Adds `rows` rows of the octave to out, each kStrip behind the one before; kFirst: to nothing.
  template <bool kFirst>
  HWY_INLINE void add(int o, int y, int rows, float* HWY_RESTRICT out) const {
    if (octaves_[o].taps == 2)
      addTaps<kFirst, 2>(o, y, rows, out);
    else
      addTaps<kFirst, 4>(o, y, rows, out);
  }

 private:
  static constexpr int kRows = 4;  // that are spread side by side

  // How samples take their points.
  enum class Way : std::uint8_t { kOneVector, kTwoVectors, kOneByOne };

  struct State {
    ValuePlanes planes;
    std::int32_t* at;  // by sample, padded: where in a plane's row its first tap is
    int firstRow;      // of the planes, among the line's points
    Way way;
    float* slice;  // as planes
  };

  // One to four rows and what they weigh.
  struct Mix {
    const float* row;
    float weight;
  };

  void setState(const ValueTables& octave, const Block& b, Scratch& scratch, State& s) const {
    const int margin = octave.settings.smooth ? 1 : 0;
    const auto pointsOf = [&](const ValueLine& line, int begin, int count, int& low) {
      std::int32_t least = line.first[begin], most = least;
      for (int i = begin; i < begin + count; ++i) {
        least = HWY_MIN(least, line.first[i]);
        most = HWY_MAX(most, line.first[i]);
      }
      low = least - margin;
      return most + octave.taps + margin - low;
    };
    int low = 0;
    const int points = pointsOf(octave.axis[0], b.x, b.width, low);
    const int rows = pointsOf(octave.axis[1], b.y, b.rows, s.firstRow);
    s.planes = ValuePlanes(octave, low, points, s.firstRow, rows, scratch);
    s.slice = scratch.take<float>(static_cast<std::size_t>(s.planes.stride()) * rows);
    s.at = scratch.take<std::int32_t>(static_cast<std::size_t>(kStrip) + kPad);
    for (int i = 0; i < b.width; ++i) s.at[i] = octave.axis[0].first[b.x + i] - low;
    std::fill(s.at + b.width, s.at + padded(b.width), s.at[b.width - 1]);
    s.way = wayOf(s.at, octave.taps);
  }

  // By how far apart the points of vectors of samples are.
  Way wayOf(const std::int32_t* at, int taps) const {
    const hn::ScalableTag<std::int32_t> di;
    const auto lanes = static_cast<int>(hn::Lanes(di));
    if (lanes < 4) return Way::kOneByOne;
    auto least = hn::Zero(di), most = hn::Zero(di);
    for (int i = 0; i < width_; i += lanes) {
      const auto away = hn::Sub(hn::Load(di, at + i), hn::Set(di, at[i]));
      least = hn::Min(least, away);
      most = hn::Max(most, away);
    }
    if (hn::GetLane(hn::MinOfLanes(di, least)) < 0) return Way::kOneByOne;
    const int span = hn::GetLane(hn::MaxOfLanes(di, most)) + taps;
    return span <= lanes ? Way::kOneVector : (span <= 2 * lanes ? Way::kTwoVectors : Way::kOneByOne);
  }

  // out = the sum of rows times weights, from float `begin` to `end`, both multiples of vectors.
  template <int kTaps>
  static HWY_INLINE void mixSome(const Mix* mix, std::ptrdiff_t begin, std::ptrdiff_t end,
                                 float* HWY_RESTRICT out) {
    const hn::ScalableTag<float> d;
    const float* HWY_RESTRICT row[kTaps];
    hn::Vec<decltype(d)> weight[kTaps];
    for (int t = 0; t < kTaps; ++t) {
      row[t] = mix[t].row;
      weight[t] = hn::Set(d, mix[t].weight);
    }
    for (std::ptrdiff_t i = begin; i < end; i += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
      auto sum = hn::Mul(weight[0], hn::Load(d, row[0] + i));
      for (int t = 1; t < kTaps; ++t) sum = hn::Add(sum, hn::Mul(weight[t], hn::Load(d, row[t] + i)));
      hn::Store(sum, d, out + i);
    }
  }
  static void mixRows(int taps, const Mix* mix, std::ptrdiff_t begin, std::ptrdiff_t end, float* out) {
    switch (taps) {
      case 1:
        return mixSome<1>(mix, begin, end, out);
      case 2:
        return mixSome<2>(mix, begin, end, out);
      case 3:
        return mixSome<3>(mix, begin, end, out);
      default:
        return mixSome<4>(mix, begin, end, out);
    }
  }

  template <bool kFirst, int kTaps>
  HWY_NOINLINE void addTaps(int o, int y, int rows, float* HWY_RESTRICT out) const {
    const State& s = states_[o];
    const ValueLine& line = octaves_[o].axis[1];
    for (int r = 0; r < rows; r += kRows) {
      const int count = HWY_MIN(rows - r, kRows);
      for (int n = 0; n < count; ++n) {
        Mix mix[kTaps];
        for (int t = 0; t < kTaps; ++t)
          mix[t] = {s.slice + s.planes.stride() * (line.first[y + r + n] + t - s.firstRow),
                    line.weight[t][y + r + n]};
        mixSome<kTaps>(mix, 0, s.planes.length(), rows_ + rowStride_ * n);
      }
      float* to = out + std::ptrdiff_t{kStrip} * r;
      if (count == kRows) {
        spread<kFirst, kTaps, kRows>(o, to);
      } else {
        for (int n = 0; n < count; ++n)
          spread<kFirst, kTaps, 1>(o, to + std::ptrdiff_t{kStrip} * n, rows_ + rowStride_ * n);
      }
    }
  }

  template <bool kFirst, int kTaps, int kCount>
  HWY_INLINE void spread(int o, float* HWY_RESTRICT out, const float* HWY_RESTRICT rows = nullptr) const {
    if (rows == nullptr) rows = rows_;
    switch (states_[o].way) {
      case Way::kOneVector:
        return spreadVectors<kFirst, kTaps, kCount, false>(o, out, rows);
      case Way::kTwoVectors:
        return spreadVectors<kFirst, kTaps, kCount, true>(o, out, rows);
      case Way::kOneByOne:
        for (int n = 0; n < kCount; ++n)
          spreadNumbers<kFirst, kTaps>(o, out + std::ptrdiff_t{kStrip} * n, rows + rowStride_ * n);
    }
  }

  template <bool kFirst, int kTaps, int kCount, bool kTwo>
  HWY_INLINE void spreadVectors(int o, float* HWY_RESTRICT out, const float* HWY_RESTRICT rows) const {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    using Indices = decltype(hn::IndicesFromVec(d, hn::Zero(di)));
    const auto lanes = static_cast<int>(hn::Lanes(d));
    const std::int32_t* HWY_RESTRICT const at = states_[o].at;
    const float* HWY_RESTRICT weights[kTaps];
    for (int t = 0; t < kTaps; ++t) weights[t] = octaves_[o].axis[0].weight[t] + x_;
    const std::ptrdiff_t stride = rowStride_;
    const int width = width_;
    for (int i = 0; i < width; i += lanes) {
      const std::int32_t base = at[i];
      const auto away = hn::Sub(hn::Load(di, at + i), hn::Set(di, base));
      V weight[kTaps];
      Indices from[kTaps];
      hn::Mask<decltype(d)> isLow[kTaps];
      for (int t = 0; t < kTaps; ++t) {
        weight[t] = hn::LoadU(d, weights[t] + i);
        auto tap = hn::Add(away, hn::Set(di, t));
        if constexpr (kTwo) {
          isLow[t] = hn::RebindMask(d, hn::Lt(tap, hn::Set(di, lanes)));
          tap = hn::And(tap, hn::Set(di, lanes - 1));
        }
        from[t] = hn::IndicesFromVec(d, tap);
      }
      for (int n = 0; n < kCount; ++n) {
        const float* HWY_RESTRICT const row = rows + stride * n + base;
        const auto low = hn::LoadU(d, row);
        V high = low;
        if constexpr (kTwo) high = hn::LoadU(d, row + lanes);
        const auto point = [&](int t) HWY_ATTR {
          const auto v = hn::TableLookupLanes(low, from[t]);
          if constexpr (kTwo) return hn::IfThenElse(isLow[t], v, hn::TableLookupLanes(high, from[t]));
          return v;
        };
        auto sum = hn::Mul(weight[0], point(0));
        for (int t = 1; t < kTaps; ++t) sum = hn::Add(sum, hn::Mul(weight[t], point(t)));
        float* HWY_RESTRICT const to = out + std::ptrdiff_t{kStrip} * n + i;
        hn::Store(hn::Add(kFirst ? hn::Zero(d) : hn::Load(d, to), sum), d, to);
      }
    }
  }

  // The processor's own gathering of so many is slower.
  template <bool kFirst, int kTaps>
  void spreadNumbers(int o, float* HWY_RESTRICT out, const float* HWY_RESTRICT row) const {
    const std::int32_t* HWY_RESTRICT const at = states_[o].at;
    const float* HWY_RESTRICT weights[kTaps];
    for (int t = 0; t < kTaps; ++t) weights[t] = octaves_[o].axis[0].weight[t] + x_;
    for (int i = 0; i < width_; ++i) {
      const float* from = row + at[i];
      float sum = weights[0][i] * from[0];
      for (int t = 1; t < kTaps; ++t) sum += weights[t][i] * from[t];
      out[i] = (kFirst ? 0.0f : out[i]) + sum;
    }
  }

  const ValueTables* octaves_;
  int count_, x_, y_, width_;
  State* states_;
  float* rows_;
  std::ptrdiff_t rowStride_;
};

// sum += weight times octaves that a fractal bends; as shaped() and its rounding to a float.
template <Fractal kFractal>
HWY_INLINE void addShaped(const float* HWY_RESTRICT octave, float weight, int count,
                          float* HWY_RESTRICT sum) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> df;
  const auto one = hn::Set(d, 1.0), two = hn::Set(d, 2.0);
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto n = hn::Abs(hn::PromoteTo(d, hn::Load(df, octave + i)));
    auto v = hn::Sub(hn::Mul(two, n), one);
    if constexpr (kFractal == Fractal::kRidged) {
      const auto rest = hn::Sub(one, n);
      v = hn::Sub(hn::Mul(hn::Mul(two, rest), rest), one);
    }
    hn::Store(hn::Add(hn::Load(df, sum + i), hn::Mul(hn::Set(df, weight), hn::DemoteTo(df, v))), df, sum + i);
  }
}

// Samples of raw sums to value `at` of the output, in doubles as storedAs() of noise.cpp.
template <Format kFormat>
HWY_NOINLINE void storeValues(const FillJob& job, const float* HWY_RESTRICT sum, int count, std::size_t at) {
  using T = typename FormatTraits<kFormat>::Type;
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::Rebind<T, decltype(d)> dt;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto apply = [d](const Affine& a, hn::Vec<decltype(d)> v) HWY_ATTR {
    v = hn::Add(hn::Mul(hn::Set(d, a.scale), v), hn::Set(d, a.bias));
    const auto low = hn::Set(d, a.low), high = hn::Set(d, a.high);
    return hn::IfThenElse(hn::Lt(v, low), low, hn::IfThenElse(hn::Lt(high, v), high, v));
  };
  T* const out = static_cast<T*>(job.out) + at;
  const Affine normalise = job.plan->normalise, quantise = job.plan->quantise;
  const auto storeAt = [&](int i, T* to) HWY_ATTR {
    auto v = apply(normalise, hn::PromoteTo(d, hn::Load(df, sum + i)));
    if constexpr (kFormat == Format::kFloat) {
      hn::StoreU(hn::DemoteTo(df, v), df, to);
    } else if constexpr (kFormat == Format::kHalf) {
      hn::StoreU(halfBits(df, hn::DemoteTo(df, v)), dt, to);
    } else {
      // Halves are rounded up, as lround() does with what is not negative.
      v = hn::Mul(hn::Set(d, static_cast<double>(hwy::HighestValue<T>())), apply(quantise, v));
      const auto whole = hn::Trunc(v);
      const auto up = hn::IfThenElseZero(hn::Ge(hn::Sub(v, whole), hn::Set(d, 0.5)), hn::Set(d, 1.0));
      const hn::Rebind<std::int32_t, decltype(d)> di;
      hn::StoreU(hn::DemoteTo(dt, hn::DemoteTo(di, hn::Add(whole, up))), dt, to);
    }
  };
  int i = 0;
  for (; i + lanes <= count; i += lanes) storeAt(i, out + i);
  if (i < count) {
    HWY_ALIGN T rest[hn::MaxLanes(hn::ScalableTag<double>())];
    storeAt(i, rest);
    std::memcpy(out + i, rest, sizeof(T) * static_cast<std::size_t>(count - i));
  }
}

inline void storeValues(const FillJob& job, const float* sum, int count, std::size_t at) {
  switch (job.format) {
    case Format::kUint8:
      return storeValues<Format::kUint8>(job, sum, count, at);
    case Format::kUint16:
      return storeValues<Format::kUint16>(job, sum, count, at);
    case Format::kHalf:
      return storeValues<Format::kHalf>(job, sum, count, at);
    case Format::kFloat:
      return storeValues<Format::kFloat>(job, sum, count, at);
  }
}

// A block of sums of octaves.
inline void fillValueBlock(const FillJob& job, const Block& b, Scratch& scratch) {
  const Fractal fractal = job.params->fractal;
  const std::size_t samples = std::size_t{kSmallChunk} * kStrip;
  float* sum = scratch.take<float>(samples);
  float* octave = fractal == Fractal::kFbm ? nullptr : scratch.take<float>(samples);
  ValueRows values(job.values, job.valueTerms, b, scratch);
  for (int z = b.z; z < b.z + b.slices; ++z) {
    values.beginSlice(z);
    for (int y = b.y; y < b.y + b.rows; y += kSmallChunk) {
      const int rows = HWY_MIN(kSmallChunk, b.y + b.rows - y), width = padded(b.width);
      if (fractal == Fractal::kFbm) {
        values.add<true>(0, y, rows, sum);
        for (int o = 1; o < job.valueTerms; ++o) values.add<false>(o, y, rows, sum);
      } else {
        std::fill_n(sum, samples, 0.0f);
        for (int o = 0; o < job.valueTerms; ++o) {
          values.add<true>(o, y, rows, octave);
          const auto weight = static_cast<float>(job.plan->values[static_cast<std::size_t>(o)].weight);
          for (int r = 0; r < rows; ++r) {
            float *to = sum + std::ptrdiff_t{kStrip} * r, *from = octave + std::ptrdiff_t{kStrip} * r;
            if (fractal == Fractal::kBillow)
              addShaped<Fractal::kBillow>(from, weight, width, to);
            else
              addShaped<Fractal::kRidged>(from, weight, width, to);
          }
        }
      }
      for (int r = 0; r < rows; ++r)
        storeValues(job, sum + std::ptrdiff_t{kStrip} * r, b.width,
                    (static_cast<std::size_t>(z) * job.box.size.y + y + r) * job.box.size.x + b.x);
    }
  }
}

// welkin::noise::addValues().
inline void addValuesTo(const ValueTables& octave, const glm::ivec3& size, float* out, Scratch& scratch) {
  scratch.reset();
  float* sum = scratch.take<float>(kStrip);
  for (int x = 0; x < size.x; x += kStrip) {
    const Block b{x, 0, 0, HWY_MIN(kStrip, size.x - x), size.y, size.z};
    ValueRows values(&octave, 1, b, scratch);
    for (int z = 0; z < size.z; ++z) {
      values.beginSlice(z);
      for (int y = 0; y < size.y; ++y) {
        float* row = out + (static_cast<std::size_t>(z) * size.y + y) * size.x + x;
        std::copy_n(row, b.width, sum);
        values.add<false>(0, y, 1, sum);
        std::copy_n(sum, b.width, row);
      }
    }
  }
}

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
