// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/texels.h"

#include <half.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

#include "welkin/core/error.h"

namespace welkin::io {
namespace {

constexpr std::array<std::string_view, 6> kChannelNames = {"a", "l", "r", "la", "rgb", "rgba"};
constexpr std::array<std::string_view, 4> kTypeNames = {"8", "16", "16f", "32f"};

// Clamped; no number becomes the lower end, or 0 where that is below.
float inside(float x, float low, float high) {
  return x >= low ? (x <= high ? x : high) : (x < low ? low : 0.0f);
}

template <class T>
void integersToFloats(const std::byte* values, std::span<float> floats) {
  constexpr float kOne = std::numeric_limits<T>::max();
  for (std::size_t i = 0; i < floats.size(); ++i) {
    T x;
    std::memcpy(&x, values + i * sizeof(T), sizeof x);
    floats[i] = static_cast<float>(x) / kOne;
  }
}

template <class T>
void floatsToIntegers(std::span<const float> floats, std::byte* values) {
  constexpr float kOne = std::numeric_limits<T>::max(), kHalfUp = 0.5f;  // as lround, which is slow
  for (std::size_t i = 0; i < floats.size(); ++i) {
    const T x = static_cast<T>(inside(floats[i], 0.0f, 1.0f) * kOne + kHalfUp);
    std::memcpy(values + i * sizeof(T), &x, sizeof x);
  }
}

float fromHalf(std::uint16_t bits) {
  half h;
  h.setBits(bits);
  return h;
}

}  // namespace

std::string nameOf(TexelFormat format) {
  return std::string(kChannelNames[static_cast<std::size_t>(format.channels)]) +
         std::string(kTypeNames[static_cast<std::size_t>(format.type)]);
}

TexelFormat texelFormat(std::string_view name) {
  for (std::size_t c = 0; c < kChannelNames.size(); ++c)
    for (std::size_t t = 0; t < kTypeNames.size(); ++t)
      if (const TexelFormat f{static_cast<Channels>(c), static_cast<ValueType>(t)}; nameOf(f) == name)
        return f;
  throw ParameterError(
      "there is no texel format \"" + std::string(name) +
      "\"; expected a, l, r, la, rgb or rgba and then 8, 16, 16f or 32f, as in l8 or rgba16f");
}

void validate(const TexelShape& shape) {
  const std::string size = std::to_string(shape.nx) + "x" + std::to_string(shape.ny) +
                           (shape.volume ? "x" + std::to_string(shape.nz) : "");
  if (shape.nx < 1 || shape.ny < 1 || shape.nz < 1 || (!shape.volume && shape.nz != 1))
    throw ParameterError(size + " texels; expected at least 1 along each axis");
  std::uint64_t bytes = shape.texelBytes();
  for (const int n : {shape.nx, shape.ny, shape.nz})
    if (__builtin_mul_overflow(bytes, static_cast<std::uint64_t>(n), &bytes) || bytes >> 63 != 0)
      throw ParameterError(size + " texels are more than can be counted");
}

void toFloats(ValueType type, std::span<const std::byte> values, std::span<float> floats) {
  assert(values.size() == floats.size() * TexelFormat{.type = type}.valueBytes());
  switch (type) {
    case ValueType::kUnorm8:
      return integersToFloats<std::uint8_t>(values.data(), floats);
    case ValueType::kUnorm16:
      return integersToFloats<std::uint16_t>(values.data(), floats);
    case ValueType::kHalf:
      for (std::size_t i = 0; i < floats.size(); ++i) {
        std::uint16_t bits;
        std::memcpy(&bits, values.data() + 2 * i, sizeof bits);
        floats[i] = fromHalf(bits);
      }
      return;
    case ValueType::kFloat:
      std::memcpy(floats.data(), values.data(), values.size());
  }
}

void fromFloats(std::span<const float> floats, ValueType type, std::span<std::byte> values) {
  assert(values.size() == floats.size() * TexelFormat{.type = type}.valueBytes());
  switch (type) {
    case ValueType::kUnorm8:
      return floatsToIntegers<std::uint8_t>(floats, values.data());
    case ValueType::kUnorm16:
      return floatsToIntegers<std::uint16_t>(floats, values.data());
    case ValueType::kHalf:
      for (std::size_t i = 0; i < floats.size(); ++i) {
        const std::uint16_t bits = half(inside(floats[i], -kLargestHalf, kLargestHalf)).bits();
        std::memcpy(values.data() + 2 * i, &bits, sizeof bits);
      }
      return;
    case ValueType::kFloat:
      std::memcpy(values.data(), floats.data(), values.size());
  }
}

float Texels::value(int x, int y, int z, int c) const {
  assert(x >= 0 && x < shape.nx && y >= 0 && y < shape.ny && z >= 0 && z < shape.nz && c >= 0 &&
         c < shape.format.channelCount());
  const std::size_t at = shape.sliceBytes() * static_cast<std::size_t>(z) +
                         shape.rowBytes() * static_cast<std::size_t>(y) +
                         shape.texelBytes() * static_cast<std::size_t>(x) +
                         bytesOf(shape.format.type) * static_cast<std::size_t>(c);
  float value = 0.0f;
  toFloats(shape.format.type, std::span(bytes).subspan(at, bytesOf(shape.format.type)), {&value, 1});
  return value;
}

std::string shortest(float x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", static_cast<double>(x));
  return text.data();
}

std::string texelPlace(const TexelShape& shape, std::size_t value) {
  const std::size_t channels = static_cast<std::size_t>(countOf(shape.format.channels));
  const std::size_t texel = value / channels, nx = static_cast<std::size_t>(shape.nx),
                    ny = static_cast<std::size_t>(shape.ny);
  std::string text = "texel (" + std::to_string(texel % nx) + ", " + std::to_string(texel / nx % ny);
  if (shape.volume) text += ", " + std::to_string(texel / nx / ny);
  text += ")";
  if (channels > 1) text += ", channel " + std::to_string(value % channels);
  return text;
}

void requireFinite(const Texels& texels, const std::filesystem::path& path, std::int64_t fileOffset) {
  const ValueType type = texels.shape.format.type;
  if (type != ValueType::kHalf && type != ValueType::kFloat) return;
  const auto check = [&]<class Bits>(Bits exponent) {
    for (std::size_t i = 0; i < texels.bytes.size() / sizeof(Bits); ++i) {
      Bits bits;
      std::memcpy(&bits, texels.bytes.data() + i * sizeof(Bits), sizeof bits);
      if ((bits & exponent) != exponent) continue;
      std::string message =
          "cannot read " + path.string() + ": no finite number at " + texelPlace(texels.shape, i);
      if (fileOffset >= 0)
        message +=
            " (byte " + std::to_string(static_cast<std::uint64_t>(fileOffset) + i * sizeof(Bits)) + ")";
      throw IoError(message);
    }
  };
  if (type == ValueType::kHalf) return check(std::uint16_t{0x7c00});
  check(std::uint32_t{0x7f800000});
}

}  // namespace welkin::io
