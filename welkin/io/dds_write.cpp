// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "welkin/core/error.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/dds.h"
#include "welkin/io/dds_format.h"

namespace welkin::io {
namespace {

using namespace dds;

// The old kind's masks, or nothing.
std::optional<PixelFormat> legacyFormat(TexelFormat f) {
  if (f == TexelFormat{Channels::kA, ValueType::kUnorm8})
    return PixelFormat{.flags = kAlpha, .bits = 8, .alpha = 0xff};
  if (f == TexelFormat{Channels::kL, ValueType::kUnorm8})
    return PixelFormat{.flags = kLuminance, .bits = 8, .red = 0xff};
  if (f == TexelFormat{Channels::kL, ValueType::kUnorm16})
    return PixelFormat{.flags = kLuminance, .bits = 16, .red = 0xffff};
  if (f == TexelFormat{Channels::kLa, ValueType::kUnorm8})
    return PixelFormat{.flags = kLuminance | kAlphaPixels, .bits = 16, .red = 0xff, .alpha = 0xff00};
  if (f == TexelFormat{Channels::kRgba, ValueType::kUnorm8})
    return PixelFormat{.flags = kRgb | kAlphaPixels,
                       .bits = 32,
                       .red = 0xff0000,
                       .green = 0xff00,
                       .blue = 0xff,
                       .alpha = 0xff000000};
  // RGBA16 has a number too, but its readers are as few as those of the DX10 header.
  for (const Plain& p : kPlain)
    if (p.format == f && p.fourCc > 100) return PixelFormat{.flags = kFourCc, .fourCc = p.fourCc};
  return std::nullopt;
}

std::uint32_t dxgiFormat(TexelFormat f) {
  for (const Plain& p : kPlain)
    if (p.format == f) return p.dxgi;
  return 0;
}

std::string heldFormats(DdsHeader header) {
  std::string names;
  for (const Channels c :
       {Channels::kA, Channels::kL, Channels::kR, Channels::kLa, Channels::kRgb, Channels::kRgba})
    for (const ValueType t : {ValueType::kUnorm8, ValueType::kUnorm16, ValueType::kHalf, ValueType::kFloat})
      if (ddsHolds({c, t}, header)) names += (names.empty() ? "" : ", ") + nameOf({c, t});
  return names;
}

}  // namespace

bool legacyDdsHolds(TexelFormat format) {
  return legacyFormat(format).has_value();
}

bool ddsHolds(TexelFormat format, DdsHeader header) {
  return dxgiFormat(format) != 0 || (header == DdsHeader::kAuto && legacyDdsHolds(format));
}

struct DdsWriter::Impl {
  Impl(const std::filesystem::path& path, const TexelShape& s, const DdsOptions& options)
      : shape(s), file(path) {
    shapes = options.mipmaps == MipFilter::kNone ? std::vector<TexelShape>{shape} : mipShapes(shape);
    writeHeader(options.header);
    std::uint64_t offset = file.position();
    for (const TexelShape& level : shapes) {
      offsets.push_back(offset);
      offset += level.bytes();
    }
    runBytes = shape.volume ? shape.sliceBytes() : shape.rowBytes();
    if (shapes.size() > 1)
      chain.emplace(shape, options.mipmaps, options.edges,
                    [this](int level, int run, std::span<const std::byte> texels) {
                      const std::size_t at = static_cast<std::size_t>(level);
                      file.seek(offsets[at] + texels.size() * static_cast<std::uint64_t>(run));
                      writeTexels(texels);
                    });
  }

  void writeHeader(DdsHeader kind) {
    const bool dx10 = kind == DdsHeader::kDx10 || !legacyDdsHolds(shape.format);
    Header h;
    h.flags = kCapsHeightWidthPitchFormat;
    h.height = static_cast<std::uint32_t>(shape.ny);
    h.width = static_cast<std::uint32_t>(shape.nx);
    h.pitch = static_cast<std::uint32_t>(shape.rowBytes());
    h.levels = static_cast<std::uint32_t>(shapes.size());
    h.caps[0] = kCapsTexture;
    if (shapes.size() > 1) {
      h.flags |= kHasLevels;
      h.caps[0] |= kCapsComplex | kCapsMipmap;
    }
    if (shape.volume) {
      h.flags |= kHasDepth;
      h.depth = static_cast<std::uint32_t>(shape.nz);
      h.caps[0] |= kCapsComplex;
      h.caps[1] = kCaps2Volume;
    }
    h.format = dx10 ? PixelFormat{.flags = kFourCc, .fourCc = dds::kDx10} : *legacyFormat(shape.format);
    swapsRedAndBlue = h.format.red == 0xff0000;
    file.write(&kMagic, sizeof kMagic);
    file.write(&h, sizeof h);
    if (!dx10) return;
    const Dx10Header more{.dxgi = dxgiFormat(shape.format),
                          .dimension = shape.volume ? kTexture3D : kTexture2D};
    file.write(&more, sizeof more);
  }

  void writeTexels(std::span<const std::byte> texels) {
    if (!swapsRedAndBlue) return file.write(texels.data(), texels.size());
    constexpr std::size_t kChunk = 1 << 16;
    for (std::size_t begin = 0; begin < texels.size(); begin += kChunk) {
      const auto part = texels.subspan(begin, std::min(kChunk, texels.size() - begin));
      swapped.assign(part.begin(), part.end());
      for (std::size_t i = 0; i + 3 < swapped.size(); i += 4) std::swap(swapped[i], swapped[i + 2]);
      file.write(swapped.data(), swapped.size());
    }
  }

  // Texels of the full level, cut into the runs that mipmaps are made from.
  void write(std::span<const std::byte> texels) {
    file.seek(offsets[0] + written);
    writeTexels(texels);
    written += texels.size();
    while (chain && !texels.empty()) {
      if (pending.empty() && texels.size() >= runBytes) {
        chain->add(texels.first(runBytes));
        texels = texels.subspan(runBytes);
        continue;
      }
      const auto part = texels.first(std::min(texels.size(), runBytes - pending.size()));
      pending.insert(pending.end(), part.begin(), part.end());
      texels = texels.subspan(part.size());
      if (pending.size() < runBytes) break;
      chain->add(pending);
      pending.clear();
    }
  }

  TexelShape shape;
  AtomicFile file;
  std::vector<TexelShape> shapes;
  std::vector<std::uint64_t> offsets;  // of the levels
  bool swapsRedAndBlue = false;
  std::optional<MipChain> chain;
  std::uint64_t written = 0;  // bytes of the full level
  std::size_t runBytes = 0;
  std::vector<std::byte> pending, swapped;
};

DdsWriter::DdsWriter(const std::filesystem::path& path, const TexelShape& shape, const DdsOptions& options) {
  const auto refuse = [&](const std::string& why) {
    throw ParameterError("cannot write " + path.string() + ": " + why);
  };
  validate(shape);
  if (!ddsHolds(shape.format, options.header))
    refuse("a DDS " + std::string(options.header == DdsHeader::kDx10 ? "with the DX10 header " : "") +
           "holds no " + nameOf(shape.format) + "; expected one of " + heldFormats(options.header));
  if (shape.rowBytes() > 0xffffffffu) refuse("its rows are longer than a DDS can say");
  impl_ = std::make_unique<Impl>(path, shape, options);
}

DdsWriter::~DdsWriter() = default;

void DdsWriter::write(std::span<const std::byte> rows) {
  assert(rows.size() % impl_->shape.rowBytes() == 0 && impl_->written + rows.size() <= impl_->shape.bytes());
  impl_->write(rows);
}

void DdsWriter::close() {
  assert(impl_->written == impl_->shape.bytes());
  impl_->file.commit();
}

void writeDds(const std::filesystem::path& path, const Texels& texels, const DdsOptions& options) {
  DdsWriter writer(path, texels.shape, options);
  writer.write(texels.bytes);
  writer.close();
}

}  // namespace welkin::io
