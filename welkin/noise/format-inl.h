// SPDX-License-Identifier: Apache-2.0
// Numbers of the caller's formats. Compiled for every instruction set, and for processors without vectors.
#if defined(WELKIN_NOISE_FORMAT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_FORMAT_INL_H_
#undef WELKIN_NOISE_FORMAT_INL_H_
#else
#define WELKIN_NOISE_FORMAT_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

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

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
