// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/texel_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "welkin/core/error.h"
#include "welkin/io/exr.h"
#include "welkin/io/file_extension.h"
#include "welkin/io/hdr.h"
#include "welkin/io/png.h"
#include "welkin/io/raw.h"
#include "welkin/io/vdb.h"

namespace welkin::io {
namespace {

// What headers of PNG and HDR say of their values stands in other kinds' metadata, by this key.
constexpr const char *kMeaning = "welkin_meaning", *kSrgb = "sRGB", *kLuminance = "linear Rec. 709, cd/m2";

constexpr std::array<Channels, 6> kAllChannels = {Channels::kL,  Channels::kR,   Channels::kA,
                                                  Channels::kLa, Channels::kRgb, Channels::kRgba};

void requirePositive(const std::filesystem::path& path, const Image<float>& image, const TexelShape& shape) {
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (image.data[i] < 0.0f)
      throw ParameterError("cannot write " + path.string() + ": " + texelPlace(shape, i) +
                           " is negative, which an HDR picture cannot hold");
}

// Pictures whose formats are written in one piece, kept as those want them.
class PictureWriter : public TexelWriter {
 public:
  PictureWriter(std::filesystem::path path, TexelFileKind kind, const TexelShape& shape,
                const TexelNotes& notes)
      : path_(std::move(path)), kind_(kind), shape_(shape), metadata_(notes.metadata) {
    const int channels = countOf(shape.format.channels);
    if (kind != TexelFileKind::kPng)
      picture_ = Image<float>(shape.nx, shape.ny, channels);
    else if (shape.format.type == ValueType::kUnorm8)
      picture_ = Image<std::uint8_t>(shape.nx, shape.ny, channels);
    else
      picture_ = Image<std::uint16_t>(shape.nx, shape.ny, channels);
  }
  void write(std::span<const std::byte> rows) override {
    const ValueType type = shape_.format.type;
    const std::size_t count = rows.size() / bytesOf(type);
    std::visit(
        [&]<class T>(Image<T>& picture) {
          const auto to = std::span(picture.data).subspan(written_, count);
          if constexpr (std::is_same_v<T, float>)
            toFloats(type, rows, to);
          else
            std::ranges::copy(rows, std::as_writable_bytes(to).begin());
        },
        picture_);
    written_ += count;
  }
  void close() override {
    assert(written_ * bytesOf(shape_.format.type) == shape_.bytes());
    std::visit([this](const auto& picture) { writePicture(picture); }, picture_);
  }

 private:
  bool means(std::string_view meaning) const {
    const auto it = metadata_.find(kMeaning);
    return it != metadata_.end() && it->second == meaning;
  }
  template <class T>
  void writePicture(const Image<T>& picture) const {
    writePng(path_, picture, metadata_, means(kSrgb));
  }
  void writePicture(const Image<float>& picture) const {
    if (kind_ == TexelFileKind::kHdr) {
      requirePositive(path_, picture, shape_);
      writeHdr(path_, picture, means(kLuminance));
    } else {
      const bool half = shape_.format.type == ValueType::kHalf;
      writeExr(path_, picture, {.depth = half ? ExrDepth::kHalf : ExrDepth::kFloat, .metadata = metadata_});
    }
  }

  std::filesystem::path path_;
  TexelFileKind kind_;
  TexelShape shape_;
  std::map<std::string, std::string> metadata_;
  std::variant<Image<float>, Image<std::uint8_t>, Image<std::uint16_t>> picture_;
  std::size_t written_ = 0;  // values
};

Texels readPngTexels(const std::filesystem::path& path) {
  PngTexts texts;
  bool srgb = false;
  const PngImage png = readPng(path, &texts, &srgb);
  if (srgb) texts.emplace(kMeaning, kSrgb);
  constexpr std::array<Channels, 5> kByCount = {Channels::kL, Channels::kL, Channels::kLa, Channels::kRgb,
                                                Channels::kRgba};
  Texels texels = std::visit(
      [&]<class T>(const Image<T>& image) {
        return toTexels(image, {kByCount[static_cast<std::size_t>(image.channels)],
                                sizeof(T) == 1 ? ValueType::kUnorm8 : ValueType::kUnorm16});
      },
      png);
  texels.notes.metadata = std::move(texts);
  return texels;
}

Texels readHdrTexels(const std::filesystem::path& path) {
  bool luminance = false;
  Texels texels = toTexels(readHdr(path, &luminance), {Channels::kRgb, ValueType::kFloat});
  if (luminance) texels.notes.metadata.emplace(kMeaning, kLuminance);
  return texels;
}

}  // namespace

TexelFileKind texelFileKindOf(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  if (extension == ".png") return TexelFileKind::kPng;
  if (extension == ".exr") return TexelFileKind::kExr;
  if (extension == ".hdr") return TexelFileKind::kHdr;
  if (extension == ".dds") return TexelFileKind::kDds;
  if (extension == ".raw") return TexelFileKind::kRaw;
  if (extension == ".vdb") return TexelFileKind::kVdb;
  if (extension == ".json" && lowerExtension(path.stem()) == ".raw") return TexelFileKind::kRaw;
  throw ParameterError(
      path.string() + ": " +
      (extension.empty() ? "no extension" : "unknown extension " + path.extension().string()) +
      "; expected .png, .exr, .hdr, .dds, .raw or .vdb");
}

bool holds(TexelFileKind kind, const TexelShape& shape, const DdsOptions& dds) {
  const auto [channels, type] = shape.format;
  switch (kind) {
    case TexelFileKind::kPng:
      return !shape.volume && isInteger(type) && channels != Channels::kA && channels != Channels::kR;
    case TexelFileKind::kExr:
      return !shape.volume && !isInteger(type) &&
             (channels == Channels::kL || channels == Channels::kRgb || channels == Channels::kRgba);
    case TexelFileKind::kHdr:
      return !shape.volume && type == ValueType::kFloat && channels == Channels::kRgb;
    case TexelFileKind::kDds:
      return ddsHolds(shape.format, dds.header);
    case TexelFileKind::kRaw:
      return true;
    case TexelFileKind::kVdb:
      return shape.volume && countOf(channels) == 1;
  }
  return false;
}

std::optional<TexelFormat> nearestFormat(TexelFileKind kind, const TexelShape& shape, const DdsOptions& dds) {
  const auto [channels, type] = shape.format;
  // As it is, another name of the same channels, more channels; of the smallest type that loses nothing.
  std::vector<Channels> candidates = {channels};
  for (const Channels c : kAllChannels) {
    const bool losesAlpha = (channels == Channels::kLa || channels == Channels::kRgba) &&
                            c != Channels::kLa && c != Channels::kRgba;
    const bool losesColour = countOf(channels) >= 3 && countOf(c) < 3;
    if (c != channels && !losesAlpha && !losesColour) candidates.push_back(c);
  }
  for (const ValueType t : {ValueType::kUnorm8, ValueType::kUnorm16, ValueType::kHalf, ValueType::kFloat}) {
    if (t != type && t != ValueType::kFloat && type != ValueType::kUnorm8) continue;  // would lose something
    if (kind == TexelFileKind::kDds && dds.header == DdsHeader::kAuto)
      for (const Channels c : candidates)
        if (countOf(c) == countOf(channels) && legacyDdsHolds({c, t})) return TexelFormat{c, t};
    for (const Channels c : candidates) {
      TexelShape s = shape;
      s.format = {c, t};
      if (holds(kind, s, dds)) return s.format;
    }
  }
  return std::nullopt;
}

std::unique_ptr<TexelWriter> createTexelFile(const std::filesystem::path& path, const TexelShape& shape,
                                             const TexelNotes& notes, const DdsOptions& dds) {
  validate(shape);
  const TexelFileKind kind = texelFileKindOf(path);
  if (!holds(kind, shape, dds))
    throw ParameterError("cannot write " + path.string() + ": " + path.extension().string() + " holds no " +
                         (shape.volume ? "volume of " : "picture of ") + nameOf(shape.format));
  switch (kind) {
    case TexelFileKind::kDds:
      return std::make_unique<DdsWriter>(path, shape, dds);
    case TexelFileKind::kRaw:
      return std::make_unique<RawWriter>(path, shape, notes);
    case TexelFileKind::kVdb:
      return std::make_unique<VdbWriter>(path, shape, notes);
    default:
      return std::make_unique<PictureWriter>(path, kind, shape, notes);
  }
}

void writeTexels(const std::filesystem::path& path, const Texels& texels, const DdsOptions& dds) {
  const auto writer = createTexelFile(path, texels.shape, texels.notes, dds);
  writer->write(texels.bytes);
  writer->close();
}

Texels readTexels(const std::filesystem::path& path) {
  Texels texels;
  switch (texelFileKindOf(path)) {
    case TexelFileKind::kPng:
      return readPngTexels(path);
    case TexelFileKind::kExr:
      texels = readExrTexels(path);
      requireFinite(texels, path);
      return texels;
    case TexelFileKind::kHdr:
      return readHdrTexels(path);
    case TexelFileKind::kDds:
      return readDds(path);
    case TexelFileKind::kRaw:
      return readRaw(path);
    case TexelFileKind::kVdb:
      break;
  }
  return readVdb(path);
}

}  // namespace welkin::io
