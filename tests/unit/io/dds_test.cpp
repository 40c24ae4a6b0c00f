// SPDX-License-Identifier: Apache-2.0
// DDS: headers byte by byte, mipmaps in the file, streaming, files of other programs, and what is refused.
#include "welkin/io/dds.h"

#include <cmath>
#include <cstring>

#include "scratch.h"
#include "some_texels.h"
#include "welkin/io/dds_format.h"

namespace welkin::io {
namespace {

std::filesystem::path dataFile(const char* name) {
  return std::filesystem::path(WELKIN_TEST_DATA_DIR) / "io" / name;
}

class Dds : public Scratch {
 protected:
  std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, contents(folder / "x.dds").data() + at, sizeof value);
    return value;
  }
  // A file of a header of the old kind and some texels.
  void put(const dds::Header& header, const std::string& texels) const {
    std::ofstream out(folder / "x.dds", std::ios::binary);
    out.write("DDS ", 4);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out << texels;
  }
  void putDx10(std::uint32_t dxgi, const std::string& texels, const dds::Dx10Header& more = {}) const {
    dds::Header header{.height = 1, .width = 2};
    header.format = {.flags = dds::kFourCc, .fourCc = dds::kDx10};
    dds::Dx10Header second = more;
    second.dxgi = dxgi;
    if (second.dimension == 0) second.dimension = dds::kTexture2D;
    put(header, std::string(reinterpret_cast<const char*>(&second), sizeof second) + texels);
  }
  std::string refusal() const {
    const std::string message = messageOf<IoError>([&] { readDds(folder / "x.dds"); });
    return message.substr(message.find(": ") + 2);
  }
};

TEST_F(Dds, LegacyHeadersAreThoseThatOthersRead) {
  struct Expected {
    const char* format;
    std::uint32_t flags, fourCc, bits, red, green, blue, alpha;
  };
  for (const Expected& e :
       std::initializer_list<Expected>{{"l8", 0x20000, 0, 8, 0xff, 0, 0, 0},
                                       {"a8", 0x2, 0, 8, 0, 0, 0, 0xff},
                                       {"la8", 0x20001, 0, 16, 0xff, 0, 0, 0xff00},
                                       {"l16", 0x20000, 0, 16, 0xffff, 0, 0, 0},
                                       {"rgba8", 0x41, 0, 32, 0xff0000, 0xff00, 0xff, 0xff000000},
                                       {"r16f", 0x4, 111, 0, 0, 0, 0, 0},
                                       {"rgba16f", 0x4, 113, 0, 0, 0, 0, 0},
                                       {"r32f", 0x4, 114, 0, 0, 0, 0, 0},
                                       {"rgba32f", 0x4, 116, 0, 0, 0, 0, 0}}) {
    const Texels texels = randomTexels(pictureOf(e.format, 6, 4));
    writeDds(folder / "x.dds", texels);
    SCOPED_TRACE(e.format);
    EXPECT_EQ(contents(folder / "x.dds").substr(0, 4), "DDS ");
    EXPECT_EQ(word(4), 124u);
    EXPECT_EQ(word(8), 0x100fu);
    EXPECT_EQ(word(12), 4u);  // height
    EXPECT_EQ(word(16), 6u);
    EXPECT_EQ(word(20), texels.shape.rowBytes());
    EXPECT_EQ(word(76), 32u);
    EXPECT_EQ(word(80), e.flags);
    EXPECT_EQ(word(84), e.fourCc);
    EXPECT_EQ(word(88), e.bits);
    EXPECT_EQ(word(92), e.red);
    EXPECT_EQ(word(96), e.green);
    EXPECT_EQ(word(100), e.blue);
    EXPECT_EQ(word(104), e.alpha);
    EXPECT_EQ(word(108), 0x1000u);
    EXPECT_EQ(word(112), 0u);
    EXPECT_EQ(contents(folder / "x.dds").size(), 128 + texels.bytes.size());
    EXPECT_FALSE(readDdsInfo(folder / "x.dds").dx10);
  }
}

TEST_F(Dds, VolumesAndMipmapsSaySo) {
  const Texels texels = randomTexels(volumeOf("l8", 8, 6, 5));
  writeDds(folder / "x.dds", texels, {.header = DdsHeader::kAuto, .mipmaps = MipFilter::kBox});
  EXPECT_EQ(word(8), 0x100fu | 0x800000 | 0x20000);
  EXPECT_EQ(word(24), 5u);
  EXPECT_EQ(word(28), 4u);  // 8, 4, 2, 1
  EXPECT_EQ(word(108), 0x1000u | 0x8 | 0x400000);
  EXPECT_EQ(word(112), 0x200000u);
  const auto levels = readDdsLevels(folder / "x.dds");
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_EQ(levels[0].bytes, texels.bytes);
  EXPECT_EQ(levels[1].shape, volumeOf("l8", 4, 3, 2));
  EXPECT_EQ(levels[3].shape, volumeOf("l8", 1, 1, 1));
  double sum = 0.0;
  for (const std::byte b : texels.bytes) sum += std::to_integer<int>(b);
  EXPECT_NEAR(levels[3].value(0, 0) * 255, sum / static_cast<double>(texels.bytes.size()), 1.0);
}

TEST_F(Dds, Dx10OnRequestAndWhereNothingElseHasTheFormat) {
  for (const char* name :
       {"r8", "a8", "r16", "r16f", "r32f", "rgb32f", "rgba8", "rgba16", "rgba16f", "rgba32f"})
    for (const bool volume : {false, true}) {
      const Texels texels = randomTexels({texelFormat(name), 5, 3, volume ? 2 : 1, volume});
      writeDds(folder / "x.dds", texels, {.header = DdsHeader::kDx10, .mipmaps = MipFilter::kKaiser});
      EXPECT_EQ(word(84), dds::kDx10);
      EXPECT_EQ(word(132), volume ? 4u : 3u);
      EXPECT_EQ(readDds(folder / "x.dds").bytes, texels.bytes);
      EXPECT_EQ(readDds(folder / "x.dds").shape, texels.shape);
    }
  writeDds(folder / "x.dds", randomTexels(pictureOf("r8", 4, 4)));
  EXPECT_EQ(word(128), 61u);
  EXPECT_TRUE(readDdsInfo(folder / "x.dds").dx10);
  EXPECT_EQ(
      messageOf<ParameterError>([&] {
        writeDds(folder / "y.dds", randomTexels(pictureOf("l8", 4, 4)), {.header = DdsHeader::kDx10});
      }),
      "cannot write " + (folder / "y.dds").string() +
          ": a DDS with the DX10 header holds no l8; expected one of a8, r8, r16, r16f, r32f, rgb32f, rgba8, "
          "rgba16, rgba16f, rgba32f");
}

// Rows in any portions, and with any number of mipmaps, give the bytes of the whole.
TEST_F(Dds, StreamsAreTheSameFile) {
  for (const bool volume : {false, true})
    for (const MipFilter filter : {MipFilter::kNone, MipFilter::kBox, MipFilter::kKaiser})
      for (const MipEdges edges : {MipEdges::kClamp, MipEdges::kRepeat}) {
        const Texels texels = randomTexels({texelFormat("rgba8"), 13, 20, volume ? 9 : 1, volume});
        const DdsOptions options{.header = DdsHeader::kAuto, .mipmaps = filter, .edges = edges};
        writeDds(folder / "whole.dds", texels, options);
        DdsWriter writer(folder / "parts.dds", texels.shape, options);
        std::span<const std::byte> left = texels.bytes;
        for (std::size_t rows = 1; !left.empty(); rows = rows * 5 % 23) {
          const auto part = left.first(std::min(left.size(), rows * texels.shape.rowBytes()));
          writer.write(part);
          left = left.subspan(part.size());
        }
        writer.close();
        EXPECT_EQ(contents(folder / "whole.dds"), contents(folder / "parts.dds"));
      }
}

TEST_F(Dds, FilesOfGimp) {
  const auto levels = readDdsLevels(dataFile("gimp_mips.dds"));
  ASSERT_EQ(levels.size(), 7u);
  EXPECT_EQ(levels[0].shape, pictureOf("rgb8", 64, 32));
  EXPECT_EQ(levels[6].shape, pictureOf("rgb8", 1, 1));
  for (int y = 0; y < 32; ++y) {
    EXPECT_NEAR(levels[0].value(17, y, 0, 0) * 255, 255.0 * (31 - y) / 31, 1.0);
    EXPECT_EQ(levels[0].value(17, y, 0, 1), 0.0f);
    EXPECT_NEAR(levels[0].value(17, y, 0, 2) * 255, 255.0 * y / 31, 1.0);
    EXPECT_NEAR(levels[1].value(9, y / 2, 0, 2) * 255, 255.0 * (y / 2 * 2 + 0.5) / 31, 1.5);
  }
  EXPECT_EQ(readDdsInfo(dataFile("gimp_mips.dds")).layout, "BGR8");

  const Texels volume = readDds(dataFile("gimp_volume_L8.dds"));
  EXPECT_EQ(volume.shape, volumeOf("l8", 16, 8, 4));
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x)
        EXPECT_EQ(std::lround(volume.value(x, y, z) * 255), (10 + 7 * x + 13 * y + 29 * z) % 256);
}

TEST_F(Dds, FilesOfNvidiaAndOpenSceneGraph) {
  const Texels nvidia = readDds(dataFile("nvtt_rgb.dds"));
  EXPECT_EQ(nvidia.shape, pictureOf("rgba8", 64, 32));
  const Texels osg = readDds(dataFile("osg_l8.dds"));
  EXPECT_EQ(osg.shape, pictureOf("l16", 64, 32));
  for (int y = 0; y < 32; ++y)
    for (const int x : {0, 63}) {
      EXPECT_NEAR(nvidia.value(x, y, 0, 0) * 255, 255.0 * (31 - y) / 31, 1.0);
      EXPECT_EQ(nvidia.value(x, y, 0, 1), 0.0f);
      EXPECT_NEAR(nvidia.value(x, y, 0, 2) * 255, 255.0 * y / 31, 1.0);
      EXPECT_EQ(nvidia.value(x, y, 0, 3), 1.0f);
      EXPECT_NEAR(osg.value(x, y) * 65535, 65535.0 * (31 - y) / 31, 1.0);
    }
}

TEST_F(Dds, OrdersOfColourByMask) {
  const auto read = [&](std::uint32_t bits, std::array<std::uint32_t, 4> masks, const std::string& texels) {
    dds::Header header{.height = 1, .width = static_cast<std::uint32_t>(texels.size() / (bits / 8))};
    header.format = {.flags = dds::kRgb | (masks[3] != 0 ? dds::kAlphaPixels : 0),
                     .bits = bits,
                     .red = masks[0],
                     .green = masks[1],
                     .blue = masks[2],
                     .alpha = masks[3]};
    put(header, texels);
    const Texels t = readDds(folder / "x.dds");
    return readDdsInfo(folder / "x.dds").layout + " " + nameOf(t.shape.format) + " " +
           std::string(reinterpret_cast<const char*>(t.bytes.data()), t.bytes.size());
  };
  EXPECT_EQ(read(32, {0xff, 0xff00, 0xff0000, 0xff000000}, "rgbaRGBA"), "RGBA8 rgba8 rgbaRGBA");
  EXPECT_EQ(read(32, {0xff0000, 0xff00, 0xff, 0xff000000}, "bgraBGRA"), "BGRA8 rgba8 rgbaRGBA");
  EXPECT_EQ(read(32, {0xff0000, 0xff00, 0xff, 0}, "bgrxBGRX"), "BGRX8 rgb8 rgbRGB");
  EXPECT_EQ(read(24, {0xff0000, 0xff00, 0xff, 0}, "bgrBGR"), "BGR8 rgb8 rgbRGB");
  EXPECT_EQ(read(24, {0xff, 0xff00, 0xff0000, 0}, "rgbRGB"), "RGB8 rgb8 rgbRGB");
  EXPECT_EQ(read(16, {0xf800, 0x7e0, 0x1f, 0}, "\x1f\xf8"),
            "16-bit colour rgb8 \xff" + std::string(1, '\0') + "\xff");
}

TEST_F(Dds, OtherDx10Formats) {
  putDx10(87, "bgraBGRA");
  EXPECT_EQ(contents(folder / "x.dds").size(), 156u);
  EXPECT_EQ(readDds(folder / "x.dds").value(0, 0, 0, 0) * 255, 'r');
  EXPECT_EQ(readDdsInfo(folder / "x.dds").layout, "BGRA8");
  putDx10(29, "rgbaRGBA");
  EXPECT_EQ(readDds(folder / "x.dds").value(1, 0, 0, 3) * 255, 'A');
  putDx10(88, "bgrxBGRX");
  EXPECT_EQ(nameOf(readDds(folder / "x.dds").shape.format), "rgb8");
}

TEST_F(Dds, WhatIsRefused) {
  dds::Header good{.height = 2, .width = 2};
  good.format = {.flags = dds::kLuminance, .bits = 8, .red = 0xff};
  put(good, "abcd");
  EXPECT_EQ(readDds(folder / "x.dds").value(1, 1) * 255, 'd');

  // The one that OpenImageIO hangs on.
  dds::Header h = good;
  h.format = {.flags = dds::kRgb, .bits = 8, .red = 0xff};
  put(h, "abcd");
  EXPECT_EQ(refusal(), "colour of 8 bits a texel; expected 16, 24 or 32 (byte 88)");
  h.format.bits = 32;
  put(h, "abcdabcdabcdabcd");
  EXPECT_EQ(refusal(),
            "the colour masks make no sense; expected red, green and blue of at most 8 bits each (byte 96)");

  h = good;
  h.format = {.flags = dds::kFourCc, .fourCc = dds::fourCc('D', 'X', 'T', '5')};
  put(h, "abcd");
  EXPECT_EQ(refusal(),
            "texels are stored as DXT5, which is not supported; expected an uncompressed DDS (byte 84)");
  h = good;
  h.caps[1] = dds::kCaps2Cube;
  put(h, "abcd");
  EXPECT_EQ(refusal(), "cube maps are not supported (byte 112)");
  h = good;
  h.width = 0;
  put(h, "abcd");
  EXPECT_EQ(refusal(), "the width is 0; expected 1 to 2147483647 (byte 16)");
  h.width = 0x80000000;
  put(h, "abcd");
  EXPECT_EQ(refusal(), "the width is 2147483648; expected 1 to 2147483647 (byte 16)");
  h = good;
  h.levels = 3;
  put(h, "abcde");
  EXPECT_EQ(refusal(), "the header claims 3 mipmaps; there are at most 2 (byte 28)");
  putDx10(98, "abcd");
  EXPECT_EQ(refusal(),
            "DXGI format 98 is not supported; block-compressed and packed formats are not (byte 128)");
  putDx10(61, "ab", {.arraySize = 6});
  EXPECT_EQ(refusal(), "arrays of textures are not supported (byte 140)");
  std::ofstream(folder / "x.dds") << "PNG or what";
  EXPECT_EQ(refusal(), "this is no DDS (byte 0)");
}

TEST_F(Dds, SizesBeyondTheFile) {
  dds::Header h{.height = 0x7fffffff, .width = 0x7fffffff, .depth = 0x7fffffff};
  h.format = {.flags = dds::kLuminance, .bits = 8, .red = 0xff};
  h.caps[1] = dds::kCaps2Volume;
  put(h, "abcd");
  EXPECT_EQ(refusal(),
            "the file is cut short: 2147483647x2147483647x2147483647 texels do not fit in its 132 bytes "
            "(byte 128)");
  h.format = {.flags = dds::kFourCc, .fourCc = 116};
  h.height = h.width = h.depth = 1 << 20;  // 2^64 bytes, which is 0 in 64 bits
  put(h, "abcd");
  EXPECT_EQ(refusal(),
            "the file is cut short: 1048576x1048576x1048576 texels do not fit in its 132 bytes (byte 128)");
  h.height = 1, h.width = 1, h.depth = 2;
  h.levels = 2;
  put(h, std::string(32, 'x'));
  EXPECT_EQ(refusal(),
            "the file is cut short: 1x1x2 texels and their mipmaps do not fit in its 160 bytes (byte 128)");
}

TEST_F(Dds, NotANumberIsRefusedWithItsByte) {
  Texels texels(pictureOf("r32f", 2, 2));
  texels.as<float>()[3] = std::nanf("");
  writeDds(folder / "x.dds", texels);
  EXPECT_EQ(refusal(), "no finite number at texel (1, 1) (byte 140)");
}

TEST_F(Dds, FullDisk) {
  EXPECT_EQ(messageOf<IoError>([&] { writeDds("/dev/full", randomTexels(pictureOf("l8", 1000, 1000))); }),
            "cannot write /dev/full: No space left on device");
}

}  // namespace
}  // namespace welkin::io
