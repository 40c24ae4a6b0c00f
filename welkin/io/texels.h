// SPDX-License-Identifier: Apache-2.0
// Texels as files hold them: a picture or a volume whose values are 8- or 16-bit integers, halves or floats,
// and whose channels have a meaning.
//
// Order in memory: channel fastest, then x, y (row 0 is the first of the file, the top of a picture) and z;
// no padding; values in the machine's byte order. Nothing is flipped between formats. Integers mean
// value / 255 or value / 65535, in [0, 1]; halves are IEEE 754 binary16.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/image.h"

namespace welkin::io {

// One value a texel has three names, since files and shaders treat them differently (a shader reads A8 as
// (0, 0, 0, a), L8 as (l, l, l, 1) and R8 as (r, 0, 0, 1)); the value is the same. RGBA is straight alpha.
enum class Channels : std::uint8_t { kA, kL, kR, kLa, kRgb, kRgba };
enum class ValueType : std::uint8_t { kUnorm8, kUnorm16, kHalf, kFloat };
inline constexpr float kLargestHalf = 65504.0f;

constexpr int countOf(Channels channels) {
  return channels == Channels::kRgba ? 4 : channels == Channels::kRgb ? 3 : channels == Channels::kLa ? 2 : 1;
}
constexpr std::size_t bytesOf(ValueType type) {
  return type == ValueType::kUnorm8 ? 1 : type == ValueType::kFloat ? 4 : 2;
}
constexpr bool isInteger(ValueType type) {
  return type == ValueType::kUnorm8 || type == ValueType::kUnorm16;
}

struct TexelFormat {
  Channels channels = Channels::kL;
  ValueType type = ValueType::kUnorm8;
  constexpr int channelCount() const { return countOf(channels); }
  constexpr std::size_t valueBytes() const { return bytesOf(type); }
  bool operator==(const TexelFormat&) const = default;
};

// "a8", "l8", "r8", "la8", "rgb8", "rgba8"; with 16 for 16-bit integers, 16f for halves and 32f for floats.
std::string nameOf(TexelFormat format);
// The format of such a name. Throws ParameterError that says what names there are.
TexelFormat texelFormat(std::string_view name);

struct TexelShape {
  TexelFormat format;
  int nx = 0, ny = 0, nz = 1;  // at least 1 each
  bool volume = false;         // a volume may have one slice; a picture always has

  std::size_t texelBytes() const {
    return format.valueBytes() * static_cast<std::size_t>(format.channelCount());
  }
  std::size_t rowBytes() const { return texelBytes() * static_cast<std::size_t>(nx); }
  std::size_t sliceBytes() const { return rowBytes() * static_cast<std::size_t>(ny); }
  std::size_t bytes() const { return sliceBytes() * static_cast<std::size_t>(nz); }
  bool operator==(const TexelShape&) const = default;
};

// Throws ParameterError unless all sizes are at least 1, a picture has one slice and the bytes can be counted
// (fewer than 2^63).
void validate(const TexelShape& shape);

// What is known beside the texels. RAW and VDB keep all of it, PNG and EXR the metadata, DDS and HDR nothing.
struct TexelNotes {
  glm::dvec3 voxelSizeM{1.0};                   // volumes: metres, along x, y and z
  glm::dvec3 firstVoxelM{0.0};                  // volumes: where the centre of voxel (0, 0, 0) is, metres
  std::string name;                             // of the volume: "density" is what renderers look for
  std::map<std::string, std::string> metadata;  // key and text
  std::vector<std::string> leftOut;             // by reading, of what the file holds: "channel Z"
};

struct Texels {
  TexelShape shape;
  TexelNotes notes;
  std::vector<std::byte> bytes;

  Texels() = default;
  explicit Texels(const TexelShape& s) : shape(s), bytes(s.bytes()) {}

  // The values as numbers of their own size: uint8_t, uint16_t (also for the bits of halves) or float.
  template <class T>
  std::span<T> as() {
    assert(sizeof(T) == shape.format.valueBytes());
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  template <class T>
  std::span<const T> as() const {
    assert(sizeof(T) == shape.format.valueBytes());
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  std::span<const std::byte> slice(int z) const {
    return std::span(bytes).subspan(shape.sliceBytes() * static_cast<std::size_t>(z), shape.sliceBytes());
  }
  // One value as a float, integers in [0, 1]. For tests and few texels; toFloats() is for many.
  float value(int x, int y, int z = 0, int c = 0) const;
};

// A run of values to floats and back. Integers are rounded to the nearest and clamped to their range, halves
// clamped to +-65504; no number (NaN) becomes 0. Both spans hold the same number of values.
void toFloats(ValueType type, std::span<const std::byte> values, std::span<float> floats);
void fromFloats(std::span<const float> floats, ValueType type, std::span<std::byte> values);

// Six digits at most, for messages.
std::string shortest(float x);

// "texel (3, 4)", "texel (3, 4, 5), channel 1": where the value of that number is, for messages.
std::string texelPlace(const TexelShape& shape, std::size_t value);

// Throws IoError that names the first texel with a NaN or an infinity, and its byte in the file if the texels
// begin at `fileOffset` there (-1: not known).
void requireFinite(const Texels& texels, const std::filesystem::path& path, std::int64_t fileOffset = -1);

// The same values as texels, copied. A volume's number of channels must be that of `channels`, as a
// picture's.
template <class T>
Texels toTexels(const Image<T>& image, TexelFormat format) {
  assert(sizeof(T) == format.valueBytes() && image.channels == format.channelCount());
  Texels texels(TexelShape{format, image.width, image.height, 1, false});
  std::memcpy(texels.bytes.data(), image.data.data(), texels.bytes.size());
  return texels;
}
template <class T>
Texels toTexels(const Volume<T>& volume, TexelFormat format) {
  assert(sizeof(T) == format.valueBytes() && volume.channels == format.channelCount());
  Texels texels(TexelShape{format, volume.nx, volume.ny, volume.nz, true});
  std::memcpy(texels.bytes.data(), volume.data.data(), texels.bytes.size());
  return texels;
}

}  // namespace welkin::io
