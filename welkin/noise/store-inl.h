// SPDX-License-Identifier: Apache-2.0
// Rows of floats to the caller's format. Compiled for every instruction set.
#if defined(WELKIN_NOISE_STORE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_STORE_INL_H_
#undef WELKIN_NOISE_STORE_INL_H_
#else
#define WELKIN_NOISE_STORE_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "welkin/noise/fill.h"
#include "welkin/noise/format-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <Format kFormat, class D, class V = hn::Vec<D>>
HWY_INLINE auto converted(const FillJob& job, D d, V v) {
  if constexpr (kFormat == Format::kUint8 || kFormat == Format::kUint16) {
    using T = typename FormatTraits<kFormat>::Type;
    // The clamp of normalised values is within that of integers.
    v = hn::MulAdd(v, hn::Set(d, job.quantiseScale), hn::Set(d, job.quantiseBias));
    v = hn::Clamp(v, hn::Zero(d), hn::Set(d, static_cast<float>(hwy::HighestValue<T>())));
    return hn::DemoteTo(hn::Rebind<T, D>(), hn::NearestInt(v));
  } else {
    v = hn::Clamp(v, hn::Set(d, job.low), hn::Set(d, job.high));
    if constexpr (kFormat == Format::kHalf)
      return halfBits(d, v);
    else
      return v;
  }
}

// Bytes of four channels, channel 0 lowest: one word a sample. Each value is rounded by adding 2^23, whose
// last bit is 1; what that leaves in the upper bits is shifted out, or taken away from channel 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToUnsigned<D>> packed(const FillJob& job, D d, V v0, V v1, V v2, V v3) {
  const hn::RebindToUnsigned<D> du;
  const auto whole = hn::Set(d, 8388608.0f);
  const auto bits = [&](V v) HWY_ATTR {
    v = hn::MulAdd(v, hn::Set(d, job.quantiseScale), hn::Set(d, job.quantiseBias));
    return hn::BitCast(du, hn::Add(hn::Clamp(v, hn::Zero(d), hn::Set(d, 255.0f)), whole));
  };
  const auto low = hn::Or(hn::Xor(bits(v0), hn::BitCast(du, whole)), hn::ShiftLeft<8>(bits(v1)));
  return hn::Or3(low, hn::ShiftLeft<16>(bits(v2)), hn::ShiftLeft<24>(bits(v3)));
}

// `count` samples of each channel, interleaved, to value `at` of the output.
template <Format kFormat, int kChannels>
HWY_INLINE void storeRowAs(const FillJob& job, const float* const* rows, int count, std::size_t at) {
  using T = typename FormatTraits<kFormat>::Type;
  const hn::ScalableTag<float> d;
  const hn::Rebind<T, decltype(d)> dt;
  const int lanes = static_cast<int>(hn::Lanes(d));
  T* out = static_cast<T*>(job.out) + at;
  // Past the caches only where whole vectors are stored to their own multiples.
  const bool stream = kFormat == Format::kFloat && kChannels == 1 && job.stream &&
                      reinterpret_cast<std::uintptr_t>(out) % (sizeof(T) * lanes) == 0;
  const auto storeAt = [&](int i, T* to, auto streamed) HWY_ATTR {
    if constexpr (kFormat == Format::kUint8 && kChannels == 4 && std::endian::native == std::endian::little) {
      const hn::RebindToUnsigned<decltype(d)> du;
      const hn::Repartition<T, decltype(du)> bytes;
      const auto words = packed(job, d, hn::LoadU(d, rows[0] + i), hn::LoadU(d, rows[1] + i),
                                hn::LoadU(d, rows[2] + i), hn::LoadU(d, rows[3] + i));
      hn::StoreU(hn::BitCast(bytes, words), bytes, to);
      return;
    }
    const auto v0 = converted<kFormat>(job, d, hn::LoadU(d, rows[0] + i));
    if constexpr (kChannels == 1 && decltype(streamed)::value) {
      hn::Stream(v0, dt, to);
    } else if constexpr (kChannels == 1) {
      hn::StoreU(v0, dt, to);
    } else {
      const auto v1 = converted<kFormat>(job, d, hn::LoadU(d, rows[1] + i));
      if constexpr (kChannels == 2) {
        hn::StoreInterleaved2(v0, v1, dt, to);
      } else {
        const auto v2 = converted<kFormat>(job, d, hn::LoadU(d, rows[2] + i));
        if constexpr (kChannels == 3)
          hn::StoreInterleaved3(v0, v1, v2, dt, to);
        else
          hn::StoreInterleaved4(v0, v1, v2, converted<kFormat>(job, d, hn::LoadU(d, rows[3] + i)), dt, to);
      }
    }
  };
  int i = 0;
  if (stream) {
    if constexpr (kFormat == Format::kFloat)
      for (; i + lanes <= count; i += lanes) storeAt(i, out + i, std::true_type());
  } else {
    for (; i + lanes <= count; i += lanes)
      storeAt(i, out + static_cast<std::ptrdiff_t>(i) * kChannels, std::false_type());
  }
  if (i < count) {
    HWY_ALIGN T rest[4 * hn::MaxLanes(hn::ScalableTag<float>())];
    storeAt(i, rest, std::false_type());
    std::memcpy(out + static_cast<std::ptrdiff_t>(i) * kChannels, rest,
                sizeof(T) * static_cast<std::size_t>(count - i) * kChannels);
  }
}

// The row of one channel's values in the output, from a sample of the box on.
template <class T>
HWY_INLINE T* rowAt(const FillJob& job, int x, int y, int z) {
  const glm::ivec3& size = job.box.size;
  return static_cast<T*>(job.out) + (static_cast<std::size_t>(z) * size.y + y) * size.x + x;
}

// One channel of floats, four vectors at a time as they are made: rows of `width` samples. Memory is written
// while the next samples are worked out.
class FloatSink {
 public:
  FloatSink(const FillJob& job, int x, int y, int z, int width)
      : out_(rowAt<float>(job, x, y, z)),
        stride_(job.box.size.x),
        width_(width),
        clamps_(job.low > hwy::LowestValue<float>() || job.high < hwy::HighestValue<float>()),
        low_(job.low),
        high_(job.high) {
    constexpr std::size_t kBytes = sizeof(float) * hn::MaxLanes(hn::ScalableTag<float>());
    stream_ = job.stream && reinterpret_cast<std::uintptr_t>(out_) % kBytes == 0 &&
              static_cast<std::size_t>(stride_) * sizeof(float) % kBytes == 0;
  }

  template <class V>
  HWY_INLINE void operator()(int row, int i, const V* made) const {
    const hn::ScalableTag<float> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    V v[4] = {made[0], made[1], made[2], made[3]};
    if (clamps_)
      for (V& one : v) one = hn::Clamp(one, hn::Set(d, low_), hn::Set(d, high_));
    float* to = out_ + row * stride_ + i;
    if (i + 4 * lanes > width_) {
      HWY_ALIGN float rest[4 * hn::MaxLanes(hn::ScalableTag<float>())];
      for (int k = 0; k < 4; ++k) hn::Store(v[k], d, rest + k * lanes);
      if (i < width_) std::memcpy(to, rest, sizeof(float) * static_cast<std::size_t>(width_ - i));
    } else if (stream_) {
      for (int k = 0; k < 4; ++k) hn::Stream(v[k], d, to + k * lanes);
    } else {
      for (int k = 0; k < 4; ++k) hn::StoreU(v[k], d, to + k * lanes);
    }
  }

 private:
  float* out_;
  std::ptrdiff_t stride_;
  int width_;
  bool clamps_;
  float low_, high_;
  bool stream_;  // past the caches, where whole vectors go to their own multiples
};

// The same of one channel of bytes.
class ByteSink {
 public:
  ByteSink(const FillJob& job, int x, int y, int z, int width)
      : job_(job), out_(rowAt<std::uint8_t>(job, x, y, z)), stride_(job.box.size.x), width_(width) {}

  template <class V>
  HWY_INLINE void operator()(int row, int i, const V* v) const {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::Repartition<std::uint8_t, decltype(du)> bytes;
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(d)), kBlocks = kLanes / 4;
    // Sample j of each vector in word j; turned round in blocks of 16 bytes; then the blocks' words of each
    // vector together.
    HWY_ALIGN static constexpr std::uint8_t kTurned[16] = {0, 4, 8,  12, 1, 5, 9,  13,
                                                           2, 6, 10, 14, 3, 7, 11, 15};
    static constexpr std::array<std::uint32_t, kLanes> kTogether = [] {
      std::array<std::uint32_t, kLanes> from{};
      for (int to = 0; to < kLanes; ++to) from[to] = 4 * (to % kBlocks) + to / kBlocks;
      return from;
    }();
    const auto turned =
        hn::BitCast(du, hn::TableLookupBytes(hn::BitCast(bytes, packed(job_, d, v[0], v[1], v[2], v[3])),
                                             hn::LoadDup128(bytes, kTurned)));
    const auto together =
        hn::BitCast(bytes, hn::TableLookupLanes(turned, hn::SetTableIndices(du, kTogether.data())));
    std::uint8_t* to = out_ + row * stride_ + i;
    if (i + 4 * kLanes <= width_) {
      hn::StoreU(together, bytes, to);
    } else if (i < width_) {
      HWY_ALIGN std::uint8_t rest[4 * kLanes];
      hn::Store(together, bytes, rest);
      std::memcpy(to, rest, static_cast<std::size_t>(width_ - i));
    }
  }

 private:
  const FillJob& job_;
  std::uint8_t* out_;
  std::ptrdiff_t stride_;
  int width_;
};

// Rows of a block, from sample x of row y and slice z of the box on; each `stride` floats behind the one
// before.
template <Format kFormat, int kChannels>
HWY_NOINLINE void storeRowsAs(const FillJob& job, const float* const* channels, int stride, int x, int y,
                              int z, int width, int rows) {
  const glm::ivec3& size = job.box.size;
  for (int r = 0; r < rows; ++r) {
    const float* row[kChannels];
    for (int c = 0; c < kChannels; ++c) row[c] = channels[c] + static_cast<std::ptrdiff_t>(r) * stride;
    storeRowAs<kFormat, kChannels>(
        job, row, width,
        ((static_cast<std::size_t>(z) * size.y + y + r) * size.x + x) * std::size_t{kChannels});
  }
}

template <Format kFormat>
HWY_INLINE void storeRowsIn(const FillJob& job, const float* const* channels, int stride, int x, int y, int z,
                            int width, int rows) {
  switch (job.channels) {
    case 1:
      return storeRowsAs<kFormat, 1>(job, channels, stride, x, y, z, width, rows);
    case 2:
      return storeRowsAs<kFormat, 2>(job, channels, stride, x, y, z, width, rows);
    case 3:
      return storeRowsAs<kFormat, 3>(job, channels, stride, x, y, z, width, rows);
    default:
      return storeRowsAs<kFormat, 4>(job, channels, stride, x, y, z, width, rows);
  }
}

inline void storeRows(const FillJob& job, const float* const* channels, int stride, int x, int y, int z,
                      int width, int rows) {
  switch (job.format) {
    case Format::kUint8:
      return storeRowsIn<Format::kUint8>(job, channels, stride, x, y, z, width, rows);
    case Format::kUint16:
      return storeRowsIn<Format::kUint16>(job, channels, stride, x, y, z, width, rows);
    case Format::kHalf:
      return storeRowsIn<Format::kHalf>(job, channels, stride, x, y, z, width, rows);
    case Format::kFloat:
      return storeRowsIn<Format::kFloat>(job, channels, stride, x, y, z, width, rows);
  }
}

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
