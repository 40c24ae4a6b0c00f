// SPDX-License-Identifier: Apache-2.0
// Rows of floats to the caller's format. Compiled for every instruction set.
#if defined(WELKIN_NOISE_STORE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_STORE_INL_H_
#undef WELKIN_NOISE_STORE_INL_H_
#else
#define WELKIN_NOISE_STORE_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

#include "welkin/noise/fill.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// To binary16, rounded to nearest even. Written out since not every instruction set rounds so by itself.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::Rebind<std::uint16_t, D>> halfBits(D d, V v) {
  const hn::RebindToUnsigned<D> du;
  const auto bits = hn::BitCast(du, v);
  const auto sign = hn::And(bits, hn::Set(du, 0x80000000u));
  const auto magnitude = hn::Xor(bits, sign);
  // Normal halves: the exponent's bias changed from 127 to 15, half of the last bit added, but for ties to
  // even.
  const auto odd = hn::And(hn::ShiftRight<13>(magnitude), hn::Set(du, 1u));
  const auto normal =
      hn::ShiftRight<13>(hn::Add(hn::Add(magnitude, odd), hn::Set(du, 0xfffu - (112u << 23))));
  // Subnormal ones: a float whose last bit is 2^-24 does the rounding.
  const auto magic = hn::Set(du, 126u << 23);
  const auto tiny =
      hn::Sub(hn::BitCast(du, hn::Add(hn::BitCast(d, magnitude), hn::BitCast(d, magic))), magic);
  // From 65520 on: infinity; beyond that not a number.
  const auto huge =
      hn::IfThenElse(hn::Gt(magnitude, hn::Set(du, 0x7f800000u)), hn::Set(du, 0x7e00u), hn::Set(du, 0x7c00u));
  auto half = hn::IfThenElse(hn::Lt(magnitude, hn::Set(du, 113u << 23)), tiny, normal);
  half = hn::IfThenElse(hn::Lt(magnitude, hn::Set(du, 0x477ff000u)), half, huge);
  half = hn::Or(half, hn::ShiftRight<16>(sign));
  return hn::DemoteTo(hn::Rebind<std::uint16_t, D>(), hn::BitCast(hn::RebindToSigned<D>(), half));
}

template <Format kFormat>
struct FormatTraits;
template <>
struct FormatTraits<Format::kUint8> {
  using Type = std::uint8_t;
};
template <>
struct FormatTraits<Format::kUint16> {
  using Type = std::uint16_t;
};
template <>
struct FormatTraits<Format::kHalf> {
  using Type = std::uint16_t;
};
template <>
struct FormatTraits<Format::kFloat> {
  using Type = float;
};

template <Format kFormat, class D, class V = hn::Vec<D>>
HWY_INLINE auto converted(const FillJob& job, D d, V v) {
  if constexpr (kFormat == Format::kUint8 || kFormat == Format::kUint16) {
    using T = typename FormatTraits<kFormat>::Type;
    v = hn::Clamp(v, hn::Set(d, job.low), hn::Set(d, job.high));
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
  HWY_ALIGN T rest[4 * hn::MaxLanes(hn::ScalableTag<float>())];
  for (int i = 0; i < count; i += lanes) {
    const bool whole = i + lanes <= count;
    T* to = whole ? out + static_cast<std::ptrdiff_t>(i) * kChannels : rest;
    const auto v0 = converted<kFormat>(job, d, hn::LoadU(d, rows[0] + i));
    if constexpr (kChannels == 1) {
      if (stream && whole)
        hn::Stream(v0, dt, to);
      else
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
    if (!whole)
      std::memcpy(out + static_cast<std::ptrdiff_t>(i) * kChannels, rest,
                  sizeof(T) * static_cast<std::size_t>(count - i) * kChannels);
  }
}

template <Format kFormat>
HWY_INLINE void storeRowIn(const FillJob& job, const float* const* rows, int count, std::size_t at) {
  switch (job.channels) {
    case 1:
      return storeRowAs<kFormat, 1>(job, rows, count, at);
    case 2:
      return storeRowAs<kFormat, 2>(job, rows, count, at);
    case 3:
      return storeRowAs<kFormat, 3>(job, rows, count, at);
    default:
      return storeRowAs<kFormat, 4>(job, rows, count, at);
  }
}

// A row of a block, from sample x of row y and slice z of the box on.
inline void storeRow(const FillJob& job, const float* const* rows, int x, int y, int z, int count) {
  const glm::ivec3& size = job.box.size;
  const std::size_t at =
      ((static_cast<std::size_t>(z) * size.y + y) * size.x + x) * static_cast<std::size_t>(job.channels);
  switch (job.format) {
    case Format::kUint8:
      return storeRowIn<Format::kUint8>(job, rows, count, at);
    case Format::kUint16:
      return storeRowIn<Format::kUint16>(job, rows, count, at);
    case Format::kHalf:
      return storeRowIn<Format::kHalf>(job, rows, count, at);
    case Format::kFloat:
      return storeRowIn<Format::kFloat>(job, rows, count, at);
  }
}

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
