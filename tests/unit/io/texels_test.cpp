// SPDX-License-Identifier: Apache-2.0
// Formats, numbers and the rules by which texels are converted.
#include <cmath>
#include <limits>

#include "scratch.h"
#include "some_texels.h"
#include "welkin/io/convert_texels.h"
#include "welkin/io/raw.h"
#include "welkin/io/texel_file.h"
#include "welkin/io/vdb.h"

namespace welkin::io {
namespace {

Texels texelsOf(const TexelShape& shape, const std::vector<float>& values) {
  Texels texels(shape);
  fromFloats(values, shape.format.type, texels.bytes);
  return texels;
}

TEST(Texels, NamesGoBothWays) {
  for (const char* name : {"a8", "l8", "r8", "la8", "rgb8", "rgba8", "l16", "r16f", "rgba32f"})
    EXPECT_EQ(nameOf(texelFormat(name)), name);
  EXPECT_EQ(texelFormat("la16f"), (TexelFormat{Channels::kLa, ValueType::kHalf}));
  for (const char* name : {"", "8", "bgra8", "l9", "r32", "RGBA8"})
    EXPECT_THROW(texelFormat(name), ParameterError);
}

TEST(Texels, ShapesAreCounted) {
  EXPECT_EQ(volumeOf("rgba16f", 3, 5, 7).bytes(), 3u * 5 * 7 * 8);
  validate(volumeOf("r8", 1 << 20, 1 << 20, 1 << 20));
  EXPECT_THROW(validate(volumeOf("r32f", 1 << 21, 1 << 21, 1 << 21)), ParameterError);
  EXPECT_THROW(validate(volumeOf("r8", 1, 0, 1)), ParameterError);
  EXPECT_THROW(validate({texelFormat("r8"), 4, 4, 2, false}), ParameterError);
}

TEST(Texels, EveryIntegerAndHalfSurvivesFloats) {
  for (const ValueType type : {ValueType::kUnorm8, ValueType::kUnorm16, ValueType::kHalf}) {
    const std::size_t count = type == ValueType::kUnorm8 ? 256 : 65536;
    std::vector<std::byte> bytes(count * bytesOf(type)), back(bytes.size());
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t bits = static_cast<std::uint32_t>(i);  // little-endian: the low bytes first
      if (type == ValueType::kHalf && (bits & 0x7c00) == 0x7c00) bits = 0;  // neither infinities nor NaNs
      std::memcpy(&bytes[i * bytesOf(type)], &bits, bytesOf(type));
    }
    std::vector<float> floats(count);
    toFloats(type, bytes, floats);
    fromFloats(floats, type, back);
    EXPECT_EQ(back, bytes);
  }
}

TEST(Texels, NumbersAreRoundedAndClamped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values = {-1.0f, 0.0f, 0.4999f / 255, 0.5001f / 255, 1.0f, 2.0f, nan};
  std::vector<std::byte> bytes(values.size());
  fromFloats(values, ValueType::kUnorm8, bytes);
  const std::vector<std::byte> expected = {std::byte{0},   std::byte{0},   std::byte{0}, std::byte{1},
                                           std::byte{255}, std::byte{255}, std::byte{0}};
  EXPECT_EQ(bytes, expected);
  Texels halves = texelsOf(pictureOf("r16f", 3, 1), {1e9f, -1e9f, nan});
  EXPECT_EQ(halves.value(0, 0), 65504.0f);
  EXPECT_EQ(halves.value(1, 0), -65504.0f);
  EXPECT_EQ(halves.value(2, 0), 0.0f);
}

TEST(Texels, NotANumberIsFoundWithItsPlace) {
  Texels texels(volumeOf("rgba32f", 3, 4, 5));
  texels.as<float>()[((2 * 4 + 1) * 3 + 2) * 4 + 3] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(messageOf<IoError>([&] { requireFinite(texels, "x.dds", 128); }),
            "cannot read x.dds: no finite number at texel (2, 1, 2), channel 3 (byte 604)");
}

TEST(ConvertTexels, OneValueBecomesGreyAndBack) {
  const Texels l = randomTexels(pictureOf("l8", 7, 5));
  EXPECT_EQ(convertTexels(l, texelFormat("a8")).bytes, l.bytes);
  const Texels colour = convertTexels(l, texelFormat("rgba16"));
  EXPECT_EQ(colour.value(3, 2, 0, 0), l.value(3, 2));
  EXPECT_EQ(colour.value(3, 2, 0, 2), l.value(3, 2));
  EXPECT_EQ(colour.value(3, 2, 0, 3), 1.0f);
  EXPECT_EQ(convertTexels(colour, texelFormat("l8")).bytes, l.bytes);
  EXPECT_EQ(convertTexels(convertTexels(l, texelFormat("r16f")), texelFormat("r8")).bytes, l.bytes);
}

TEST(ConvertTexels, WhatCannotBeKeptIsNamed) {
  Texels colour = texelsOf(pictureOf("rgba8", 2, 1), {0, 0, 0, 1, 0, 0.2f, 0, 1});
  EXPECT_EQ(messageOf<ParameterError>([&] { convertTexels(colour, texelFormat("l8")); }),
            "texel (1, 0), channel 0 is not grey, which l8 cannot hold");
  colour = texelsOf(pictureOf("la8", 1, 2), {0, 1, 0, 0.6f});
  EXPECT_EQ(messageOf<ParameterError>([&] { convertTexels(colour, texelFormat("l8")); }),
            "texel (0, 1), channel 1 has alpha 0.6, which l8 cannot hold");
  const Texels bright = texelsOf(volumeOf("r32f", 1, 1, 3), {0.0f, 1.0f, 1.5f});
  EXPECT_EQ(messageOf<ParameterError>([&] { convertTexels(bright, texelFormat("r8")); }),
            "texel (0, 0, 2) is 1.5, which r8 cannot hold");
  convertTexels(bright, texelFormat("r16f"));
}

TEST(TexelFile, NearestFormatLosesNothing) {
  const auto nearest = [](TexelFileKind kind, const char* from, bool volume = false) {
    const auto format = nearestFormat(kind, {texelFormat(from), 4, 4, volume ? 4 : 1, volume});
    return format ? nameOf(*format) : "none";
  };
  EXPECT_EQ(nearest(TexelFileKind::kDds, "rgb8"), "rgba8");
  EXPECT_EQ(nearest(TexelFileKind::kDds, "r8"), "l8");  // that more programs read
  EXPECT_EQ(nearest(TexelFileKind::kDds, "a8"), "a8");
  EXPECT_EQ(nearest(TexelFileKind::kDds, "l16"), "l16");
  EXPECT_EQ(nearest(TexelFileKind::kDds, "rgb16"), "rgba16");
  EXPECT_EQ(nearest(TexelFileKind::kDds, "l16f"), "r16f");
  EXPECT_EQ(nearest(TexelFileKind::kDds, "rgb16f"), "rgba16f");
  EXPECT_EQ(nearest(TexelFileKind::kPng, "a8"), "l8");
  EXPECT_EQ(nearest(TexelFileKind::kPng, "r32f"), "none");
  EXPECT_EQ(nearest(TexelFileKind::kPng, "l8", true), "none");
  EXPECT_EQ(nearest(TexelFileKind::kExr, "r8"), "l16f");
  EXPECT_EQ(nearest(TexelFileKind::kExr, "rgba16"), "rgba32f");
  EXPECT_EQ(nearest(TexelFileKind::kHdr, "l8"), "rgb32f");
  EXPECT_EQ(nearest(TexelFileKind::kHdr, "rgba8"), "none");
  EXPECT_EQ(nearest(TexelFileKind::kVdb, "r16f", true), "r16f");
  EXPECT_EQ(nearest(TexelFileKind::kVdb, "rgb8", true), "none");
}

class TexelFiles : public Scratch {};

// All that a kind of file holds comes back, through the one door.
TEST_F(TexelFiles, RoundTrip) {
  int written = 0;
  for (const char* name : {"x.png", "x.exr", "x.hdr", "x.dds", "x.raw", "x.vdb"})
    for (const char* channels : {"a", "l", "r", "la", "rgb", "rgba"})
      for (const char* type : {"8", "16", "16f", "32f"})
        for (const bool volume : {false, true}) {
          const TexelFileKind kind = texelFileKindOf(name);
          const TexelShape shape{texelFormat(std::string(channels) + type), 9, 6, volume ? 11 : 1, volume};
          if (!holds(kind, shape) || (kind == TexelFileKind::kVdb && !hasVdb())) continue;
          Texels texels = randomTexels(shape);
          const bool notes = kind == TexelFileKind::kRaw || kind == TexelFileKind::kVdb;
          if (notes && volume) {
            texels.notes.voxelSizeM = {20.0, 10.0, 5.5};
            texels.notes.firstVoxelM = {-7.0, 0.25, 900.0};
            texels.notes.name = "extinction";
          }
          if (kind != TexelFileKind::kDds && kind != TexelFileKind::kHdr) texels.notes.metadata["seed"] = "7";
          writeTexels(folder / name, texels);
          const std::string first = contents(folder / name);
          writeTexels(folder / name, texels);
          EXPECT_EQ(contents(folder / name), first) << name << " " << nameOf(shape.format);
          const Texels back = readTexels(folder / name);
          ++written;
          SCOPED_TRACE(std::string(name) + " " + nameOf(shape.format));
          EXPECT_EQ(back.notes.metadata, texels.notes.metadata);
          EXPECT_EQ(back.notes.voxelSizeM, texels.notes.voxelSizeM);
          EXPECT_EQ(back.notes.firstVoxelM, texels.notes.firstVoxelM);
          EXPECT_EQ(back.notes.name, texels.notes.name);
          if (kind == TexelFileKind::kHdr) {
            for (std::size_t i = 0; i < texels.as<float>().size(); ++i)
              EXPECT_NEAR(back.as<float>()[i], texels.as<float>()[i], 1.0 / 256);
          } else if (kind == TexelFileKind::kVdb) {
            EXPECT_EQ(convertTexels(back, shape.format).bytes, texels.bytes);
          } else {
            EXPECT_EQ(back.shape, shape);
            EXPECT_EQ(back.bytes, texels.bytes);
          }
        }
  EXPECT_EQ(written, 4 * 2 + 3 * 2 + 1 + 26 + 48 + (hasVdb() ? 12 : 0));
}

TEST_F(TexelFiles, RawByEitherOfItsNames) {
  Texels texels = randomTexels(volumeOf("r16f", 5, 4, 3));
  texels.notes.name = "extinction";
  writeRaw(folder / "x.raw.json", texels);
  EXPECT_EQ(std::filesystem::file_size(folder / "x.raw"), texels.shape.bytes());
  const Texels back = readRaw(folder / "x.raw");
  EXPECT_EQ(back.shape, texels.shape);
  EXPECT_EQ(back.bytes, texels.bytes);
  EXPECT_EQ(back.notes.name, "extinction");
}

TEST_F(TexelFiles, ErrorsAndLeftovers) {
  EXPECT_EQ(messageOf<ParameterError>([] { texelFileKindOf("a.tga"); }),
            "a.tga: unknown extension .tga; expected .png, .exr, .hdr, .dds, .raw or .vdb");
  EXPECT_EQ(texelFileKindOf("A.RAW.json"), TexelFileKind::kRaw);
  const Texels volume = randomTexels(volumeOf("r8", 8, 8, 8)), colour = randomTexels(pictureOf("rgb8", 8, 8));
  EXPECT_THROW(writeTexels(folder / "a.png", volume), ParameterError);
  EXPECT_THROW(writeTexels(folder / "a.dds", colour), ParameterError);
  EXPECT_THROW(writeTexels(folder / "a.vdb", colour), ParameterError);
  for (const char* name : {"a.dds", "a.raw", "a.vdb"}) {
    if (name == std::string("a.vdb") && !hasVdb()) continue;
    EXPECT_THROW(writeTexels(folder / "none" / name, volume), IoError);
    {
      const auto writer = createTexelFile(folder / name, volume.shape);
      writer->write(volume.slice(0));
    }
    EXPECT_EQ(fileCount(), 0) << name;
    EXPECT_THROW(readTexels(folder / name), IoError);
  }
}

}  // namespace
}  // namespace welkin::io
