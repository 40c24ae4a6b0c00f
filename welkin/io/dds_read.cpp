// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <climits>
#include <cstring>

#include "welkin/io/dds.h"
#include "welkin/io/dds_format.h"
#include "welkin/io/input_file.h"

namespace welkin::io {
namespace {

using namespace dds;

constexpr std::uint64_t kFormatByte = 76, kFourCcByte = 84, kMasksByte = 88, kDx10Byte = 128;

// How texels stand in the file: as in memory, or as whole numbers of `bytes` bytes out of which masks cut
// channels.
struct Layout {
  TexelFormat format;
  std::string name;
  bool plain = true;
  std::size_t bytes = 0;                 // a texel in the file
  std::array<std::uint32_t, 4> masks{};  // of the channels in memory
};

Layout plainLayout(const Plain& p) {
  return {p.format,
          p.name,
          true,
          bytesOf(p.format.type) * static_cast<std::size_t>(countOf(p.format.channels)),
          {}};
}

Layout maskLayout(Channels channels, const std::string& name, std::size_t bytes,
                  std::array<std::uint32_t, 4> masks) {
  return {{channels, ValueType::kUnorm8}, name, false, bytes, masks};
}

Layout dx10Layout(const InputFile& file, std::uint32_t dxgi) {
  for (const Plain& p : kPlain)
    if (p.dxgi == dxgi) return plainLayout(p);
  constexpr std::uint32_t kRgba8Srgb = 29, kBgra8 = 87, kBgrx8 = 88, kBgra8Srgb = 91, kBgrx8Srgb = 93;
  switch (dxgi) {
    case kRgba8Srgb:
      return {{Channels::kRgba, ValueType::kUnorm8}, "RGBA8 sRGB", true, 4, {}};
    case kBgra8:
    case kBgra8Srgb:
      return maskLayout(Channels::kRgba, dxgi == kBgra8 ? "BGRA8" : "BGRA8 sRGB", 4,
                        {0xff0000, 0xff00, 0xff, 0xff000000});
    case kBgrx8:
    case kBgrx8Srgb:
      return maskLayout(Channels::kRgb, dxgi == kBgrx8 ? "BGRX8" : "BGRX8 sRGB", 4,
                        {0xff0000, 0xff00, 0xff, 0});
    default:
      file.fail("DXGI format " + std::to_string(dxgi) +
                    " is not supported; block-compressed and packed formats are not",
                kDx10Byte);
  }
}

Layout fourCcLayout(const InputFile& file, std::uint32_t code) {
  for (const Plain& p : kPlain)
    if (p.fourCc != 0 && p.fourCc == code) return plainLayout(p);
  std::string name;
  for (int i = 0; i < 4; ++i) {
    const char c = static_cast<char>(code >> (8 * i));
    if (c >= ' ' && c <= '~') name += c;
  }
  if (name.size() == 4)
    file.fail("texels are stored as " + name + ", which is not supported; expected an uncompressed DDS",
              kFourCcByte);
  file.fail("format number " + std::to_string(code) + " is not supported", kFourCcByte);
}

// Colour by masks: 16, 24 or 32 bits, at most 8 a channel.
Layout colourLayout(const InputFile& file, const PixelFormat& f) {
  const bool alpha = (f.flags & kAlphaPixels) != 0 && f.alpha != 0;
  const std::array<std::uint32_t, 4> masks = {f.red, f.green, f.blue, alpha ? f.alpha : 0};
  if (f.bits != 16 && f.bits != 24 && f.bits != 32)
    file.fail("colour of " + std::to_string(f.bits) + " bits a texel; expected 16, 24 or 32", kMasksByte);
  std::uint32_t taken = 0;
  for (std::size_t c = 0; c < (alpha ? 4u : 3u); ++c) {
    const std::uint32_t mask = masks[c];
    const int width = std::popcount(mask);
    const bool oneRun = mask != 0 && (mask >> std::countr_zero(mask)) == (1ull << width) - 1;
    if (!oneRun || width > 8 || (mask & taken) != 0 || (f.bits < 32 && mask >> f.bits != 0))
      file.fail("the colour masks make no sense; expected red, green and blue of at most 8 bits each",
                kMasksByte + 4 + 4 * c);
    taken |= mask;
  }
  std::string name = std::to_string(f.bits) + "-bit colour";
  if (f.bits >= 24 && taken >> 24 != 0xff && f.red == 0xff0000 && f.blue == 0xff)
    name = f.bits == 24 ? "BGR8" : "BGRX8";
  if (f.bits >= 24 && taken >> 24 != 0xff && f.red == 0xff && f.blue == 0xff0000)
    name = f.bits == 24 ? "RGB8" : "RGBX8";
  if (f.alpha == 0xff000000 && alpha && f.red == 0xff0000 && f.blue == 0xff) name = "BGRA8";
  if (f.alpha == 0xff000000 && alpha && f.red == 0xff && f.blue == 0xff0000) name = "RGBA8";
  return maskLayout(alpha ? Channels::kRgba : Channels::kRgb, name, f.bits / 8, masks);
}

Layout legacyLayout(const InputFile& file, const PixelFormat& f) {
  const auto eightBits = [&](Channels channels, const char* name) {
    return Layout{{channels, ValueType::kUnorm8}, name, true, f.bits / 8, {}};
  };
  if ((f.flags & kFourCc) != 0) return fourCcLayout(file, f.fourCc);
  if ((f.flags & kLuminance) != 0) {
    const bool alpha = (f.flags & kAlphaPixels) != 0;
    if (f.bits == 8 && !alpha && f.red == 0xff) return eightBits(Channels::kL, "L8");
    if (f.bits == 16 && alpha && f.red == 0xff && f.alpha == 0xff00) return eightBits(Channels::kLa, "L8A8");
    if (f.bits == 16 && !alpha && (f.red == 0xffff || f.red == 0xff))
      return {{Channels::kL, ValueType::kUnorm16}, "L16", true, 2, {}};
    file.fail("luminance of these bits is not supported; expected L8, L8A8 or L16", kMasksByte);
  }
  if ((f.flags & kRgb) != 0) return colourLayout(file, f);
  if ((f.flags & kAlpha) != 0 && f.bits == 8) return eightBits(Channels::kA, "A8");
  file.fail("this kind of texel is not supported; expected luminance, alpha, colour, halves or floats",
            kFormatByte);
}

struct Parsed {
  DdsInfo info;
  Layout layout;
};

int sizeOf(const InputFile& file, std::uint32_t n, const char* what, std::uint64_t byte) {
  if (n < 1 || n > INT_MAX)
    file.fail(std::string(what) + " is " + std::to_string(n) + "; expected 1 to 2147483647", byte);
  return static_cast<int>(n);
}

Parsed parse(InputFile& file) {
  if (file.size() < 4 || file.get<std::uint32_t>() != kMagic) file.fail("this is no DDS", 0);
  const auto h = file.get<Header>();
  if (h.size != sizeof(Header))
    file.fail("the header says that it has " + std::to_string(h.size) + " bytes; expected 124", 4);
  if (h.format.size != sizeof(PixelFormat))
    file.fail("the texel format says that it has " + std::to_string(h.format.size) + " bytes; expected 32",
              kFormatByte);
  Parsed p;
  bool volume = (h.caps[1] & kCaps2Volume) != 0 || ((h.flags & kHasDepth) != 0 && h.depth > 1);
  if ((h.caps[1] & kCaps2Cube) != 0) file.fail("cube maps are not supported", 112);
  if ((h.format.flags & kFourCc) != 0 && h.format.fourCc == dds::kDx10) {
    const auto more = file.get<Dx10Header>();
    if (more.dimension != kTexture2D && more.dimension != kTexture3D)
      file.fail(
          "resource dimension " + std::to_string(more.dimension) + "; expected 3 (picture) or 4 (volume)",
          132);
    if ((more.misc & kMiscCube) != 0) file.fail("cube maps are not supported", 136);
    if (more.arraySize > 1) file.fail("arrays of textures are not supported", 140);
    volume = more.dimension == kTexture3D;
    p.layout = dx10Layout(file, more.dxgi);
    p.info.dx10 = true;
  } else {
    p.layout = legacyLayout(file, h.format);
  }
  TexelShape& shape = p.info.shape;
  shape.format = p.layout.format;
  shape.volume = volume;
  shape.ny = sizeOf(file, h.height, "the height", 12);
  shape.nx = sizeOf(file, h.width, "the width", 16);
  shape.nz = volume ? sizeOf(file, h.depth, "the depth", 24) : 1;
  p.info.layout = p.layout.name;
  p.info.offset = file.position();

  const int possible =
      static_cast<int>(std::bit_width(static_cast<std::uint32_t>(std::max({shape.nx, shape.ny, shape.nz}))));
  if (h.levels > static_cast<std::uint32_t>(possible))
    file.fail("the header claims " + std::to_string(h.levels) + " mipmaps; there are at most " +
                  std::to_string(possible),
              28);
  p.info.levels = static_cast<int>(std::max(h.levels, 1u));

  // Nothing is allocated before the file is known to hold it. An overflow is more than any file.
  std::uint64_t total = 0;
  TexelShape level = shape;
  for (int i = 0; i < p.info.levels; ++i) {
    std::uint64_t bytes = p.layout.bytes;
    bool overflow = false;
    for (const int n : {level.nx, level.ny, level.nz})
      overflow = overflow || __builtin_mul_overflow(bytes, static_cast<std::uint64_t>(n), &bytes);
    overflow = overflow || __builtin_add_overflow(total, bytes, &total);
    if (overflow || total > file.left())
      file.fail("the file is cut short: " + std::to_string(shape.nx) + "x" + std::to_string(shape.ny) +
                    (volume ? "x" + std::to_string(shape.nz) : "") + " texels" +
                    (p.info.levels > 1 ? " and their mipmaps" : "") + " do not fit in its " +
                    std::to_string(file.size()) + " bytes",
                p.info.offset);
    level.nx = std::max(level.nx / 2, 1);
    level.ny = std::max(level.ny / 2, 1);
    level.nz = std::max(level.nz / 2, 1);
  }
  return p;
}

// Channels of at most 8 bits out of texels of 2 to 4 bytes; those without a mask are left out.
void unpack(const Layout& layout, std::span<const std::byte> in, std::span<std::byte> out) {
  struct Channel {
    std::uint32_t mask;
    int shift;
    std::uint32_t largest;
  };
  std::vector<Channel> channels;
  for (const std::uint32_t mask : layout.masks)
    if (mask != 0) channels.push_back({mask, std::countr_zero(mask), mask >> std::countr_zero(mask)});
  std::size_t o = 0;
  for (std::size_t i = 0; i < in.size(); i += layout.bytes) {
    std::uint32_t texel = 0;
    std::memcpy(&texel, &in[i], layout.bytes);
    for (const Channel& c : channels)
      out[o++] = static_cast<std::byte>((((texel & c.mask) >> c.shift) * 255 + c.largest / 2) / c.largest);
  }
}

Texels readLevel(InputFile& file, const Layout& layout, const TexelShape& shape) {
  const auto start = static_cast<std::int64_t>(file.position());
  Texels texels(shape);
  if (layout.plain) {
    file.read(texels.bytes.data(), texels.bytes.size());
    requireFinite(texels, file.path(), start);
    return texels;
  }
  constexpr std::size_t kTexelsAtOnce = 1 << 14;
  const std::size_t count = texels.bytes.size() / shape.texelBytes();
  std::vector<std::byte> packed;
  for (std::size_t begin = 0; begin < count; begin += kTexelsAtOnce) {
    const std::size_t n = std::min(kTexelsAtOnce, count - begin);
    packed.resize(n * layout.bytes);
    file.read(packed.data(), packed.size());
    unpack(layout, packed,
           std::span(texels.bytes).subspan(begin * shape.texelBytes(), n * shape.texelBytes()));
  }
  return texels;
}

}  // namespace

DdsInfo readDdsInfo(const std::filesystem::path& path) {
  InputFile file(path);
  return parse(file).info;
}

Texels readDds(const std::filesystem::path& path) {
  InputFile file(path);
  const Parsed p = parse(file);
  return readLevel(file, p.layout, p.info.shape);
}

std::vector<Texels> readDdsLevels(const std::filesystem::path& path) {
  InputFile file(path);
  const Parsed p = parse(file);
  std::vector<Texels> levels;
  TexelShape shape = p.info.shape;
  for (int i = 0; i < p.info.levels; ++i) {
    levels.push_back(readLevel(file, p.layout, shape));
    shape.nx = std::max(shape.nx / 2, 1);
    shape.ny = std::max(shape.ny / 2, 1);
    shape.nz = std::max(shape.nz / 2, 1);
  }
  return levels;
}

}  // namespace welkin::io
