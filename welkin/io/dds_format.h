// SPDX-License-Identifier: Apache-2.0
// What dds_read.cpp and dds_write.cpp share: the header's fields and the table of formats. Not for others.
// The names are those of Microsoft's "Programming Guide for DDS" without their prefixes.
#pragma once

#include <array>
#include <cstdint>

#include "welkin/io/texels.h"

namespace welkin::io::dds {

constexpr std::uint32_t fourCc(char a, char b, char c, char d) {
  const auto byte = [](char x) { return static_cast<std::uint32_t>(static_cast<unsigned char>(x)); };
  return byte(a) | byte(b) << 8 | byte(c) << 16 | byte(d) << 24;
}

constexpr std::uint32_t kMagic = fourCc('D', 'D', 'S', ' ');

struct PixelFormat {
  std::uint32_t size = 32, flags = 0, fourCc = 0, bits = 0;
  std::uint32_t red = 0, green = 0, blue = 0, alpha = 0;  // masks
};
constexpr std::uint32_t kAlphaPixels = 0x1, kAlpha = 0x2, kFourCc = 0x4, kRgb = 0x40, kLuminance = 0x20000;

struct Header {  // follows the magic number
  std::uint32_t size = 124, flags = 0, height = 0, width = 0, pitch = 0, depth = 0, levels = 1;
  std::array<std::uint32_t, 11> reserved{};
  PixelFormat format{};
  std::array<std::uint32_t, 4> caps{};
  std::uint32_t reserved2 = 0;
};
static_assert(sizeof(Header) == 124);
constexpr std::uint32_t kCapsHeightWidthPitchFormat = 0x100f, kHasLevels = 0x20000, kHasDepth = 0x800000;
constexpr std::uint32_t kCapsComplex = 0x8, kCapsTexture = 0x1000, kCapsMipmap = 0x400000;
constexpr std::uint32_t kCaps2Cube = 0x200, kCaps2Volume = 0x200000;

struct Dx10Header {  // follows where the four-character code is DX10
  std::uint32_t dxgi = 0, dimension = 0, misc = 0, arraySize = 1, misc2 = 0;
};
static_assert(sizeof(Dx10Header) == 20);
constexpr std::uint32_t kDx10 = fourCc('D', 'X', '1', '0');
constexpr std::uint32_t kTexture2D = 3, kTexture3D = 4, kMiscCube = 0x4;

// Formats whose values stand in the file as they do in memory, with their number in the DX10 header and their
// number in place of a four-character code; 0: has none.
struct Plain {
  TexelFormat format;
  std::uint32_t dxgi, fourCc;
  const char* name;
};
constexpr std::array<Plain, 10> kPlain = {{
    {{Channels::kR, ValueType::kUnorm8}, 61, 0, "R8"},
    {{Channels::kA, ValueType::kUnorm8}, 65, 0, "A8"},
    {{Channels::kR, ValueType::kUnorm16}, 56, 0, "R16"},
    {{Channels::kR, ValueType::kHalf}, 54, 111, "R16F"},
    {{Channels::kR, ValueType::kFloat}, 41, 114, "R32F"},
    {{Channels::kRgb, ValueType::kFloat}, 6, 0, "RGB32F"},
    {{Channels::kRgba, ValueType::kUnorm8}, 28, 0, "RGBA8"},
    {{Channels::kRgba, ValueType::kUnorm16}, 11, 36, "RGBA16"},
    {{Channels::kRgba, ValueType::kHalf}, 10, 113, "RGBA16F"},
    {{Channels::kRgba, ValueType::kFloat}, 2, 116, "RGBA32F"},
}};

}  // namespace welkin::io::dds
