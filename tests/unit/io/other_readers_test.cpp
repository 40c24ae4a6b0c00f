// SPDX-License-Identifier: Apache-2.0
// Files shown to other people's readers, which must find the same texels: OpenSceneGraph (through
// osg_texels.cpp), OpenImageIO, ImageMagick. A reader that is not installed is a failure. What some reader is
// known not to read (docs/file_formats.md) is not shown to it.
#include <cmath>
#include <cstdio>
#include <sstream>

#include "scratch.h"
#include "some_texels.h"
#include "welkin/io/texel_file.h"
#include "welkin/io/vdb.h"

namespace welkin::io {
namespace {

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte b : bytes) {
    text += "0123456789abcdef"[std::to_integer<unsigned>(b) >> 4];
    text += "0123456789abcdef"[std::to_integer<unsigned>(b) & 15];
  }
  return text;
}

// As the texels stand in the file: colour of 8 bits has blue first.
std::vector<std::byte> fileOrder(const Texels& texels) {
  std::vector<std::byte> bytes = texels.bytes;
  if (texels.shape.format == texelFormat("rgba8"))
    for (std::size_t i = 0; i < bytes.size(); i += 4) std::swap(bytes[i], bytes[i + 2]);
  return bytes;
}

class OtherReaders : public Scratch {
 protected:
  std::string path(const char* name = "x.dds") const { return (folder / name).string(); }

  // What oiiotool finds: the numbers of each texel in order, integers as they are stored.
  std::vector<float> openImageIo(const char* name) const {
    std::istringstream lines(outputOf("timeout 60 oiiotool --no-autopremult --dumpdata " + path(name)));
    std::vector<float> values;
    std::string line;
    std::getline(lines, line);  // what it is
    while (std::getline(lines, line)) {
      const std::size_t begin = line.find("): ");
      if (begin == std::string::npos) continue;
      std::istringstream numbers(line.substr(begin + 3));
      for (float x; numbers >> x;) values.push_back(x);
    }
    return values;
  }

  // What ImageMagick finds: all slices as bytes of these channels.
  std::string imageMagick(const char* name, const std::string& channels) const {
    const std::string raw = path("im.raw");
    outputOf("convert " + path(name) + " -depth 8 " + channels + ":" + raw);
    return contents(raw);
  }
};

std::vector<float> storedNumbers(const Texels& texels) {
  std::vector<float> values(texels.bytes.size() / bytesOf(texels.shape.format.type));
  toFloats(texels.shape.format.type, texels.bytes, values);
  const ValueType type = texels.shape.format.type;
  for (float& x : values)
    if (type == ValueType::kUnorm8 || type == ValueType::kUnorm16)
      x = std::round(x * (type == ValueType::kUnorm8 ? 255.0f : 65535.0f));
  return values;
}

std::string asText(const Texels& texels) {
  return {reinterpret_cast<const char*>(texels.bytes.data()), texels.bytes.size()};
}

TEST_F(OtherReaders, OpenSceneGraphReadsEveryDdsWithItsMipmaps) {
  struct Case {
    const char *format, *osg;
    int bits;
  };
  for (const auto& [format, osg, bits] : std::initializer_list<Case>{{"l8", "L", 8},
                                                                     {"a8", "A", 8},
                                                                     {"la8", "LA", 16},
                                                                     {"l16", "L", 16},
                                                                     {"rgba8", "BGRA", 32},
                                                                     {"r16f", "R", 16},
                                                                     {"rgba16f", "RGBA", 64},
                                                                     {"r32f", "R", 32},
                                                                     {"rgba32f", "RGBA", 128},
                                                                     {"r16", "R", 16},
                                                                     {"rgba16", "RGBA", 64},
                                                                     {"rgb32f", "RGB", 96}})
    for (const bool volume : {false, true})
      for (const bool mipmaps : {false, true}) {
        const Texels texels = randomTexels({texelFormat(format), 8, 4, volume ? 2 : 1, volume});
        writeDds(path(), texels,
                 {.header = DdsHeader::kAuto, .mipmaps = mipmaps ? MipFilter::kBox : MipFilter::kNone});
        std::string all;
        for (const Texels& level : readDdsLevels(path())) all += hex(fileOrder(level));
        EXPECT_EQ(all.substr(0, 2 * texels.bytes.size()), hex(fileOrder(texels)));
        EXPECT_EQ(outputOf(std::string(WELKIN_OSG_TEXELS) + " " + path()),
                  "8x4x" + std::string(volume ? "2 " : "1 ") + osg + " " + std::to_string(bits) + "-bit " +
                      (mipmaps ? "4" : "1") + " levels: " + all + "\n")
            << format;
      }
}

TEST_F(OtherReaders, OpenImageIoReadsDds) {
  for (const char* format : {"l8", "a8", "la8", "rgba8"})
    for (const bool mipmaps : {false, true}) {
      const Texels texels = randomTexels(pictureOf(format, 16, 8));
      writeDds(path(), texels,
               {.header = DdsHeader::kAuto, .mipmaps = mipmaps ? MipFilter::kKaiser : MipFilter::kNone});
      EXPECT_EQ(openImageIo("x.dds"), storedNumbers(texels)) << format;
      if (mipmaps) {
        outputOf("oiiotool --no-autopremult " + path() + " --selectmip 2 -o " + path("mip.tif"));
        EXPECT_EQ(openImageIo("mip.tif"), storedNumbers(readDdsLevels(path())[2])) << format;
      }
    }
  const Texels volume = randomTexels(volumeOf("rgba8", 8, 8, 4));
  writeDds(path(), volume, {.header = DdsHeader::kAuto, .mipmaps = MipFilter::kBox});
  EXPECT_EQ(openImageIo("x.dds"), storedNumbers(volume));
}

TEST_F(OtherReaders, ImageMagickReadsDds) {
  for (const char* format : {"l8", "rgba8"})
    for (const bool volume : {false, true}) {
      const Texels texels = randomTexels({texelFormat(format), 12, 5, volume ? 3 : 1, volume});
      writeDds(path(), texels,
               {.header = DdsHeader::kAuto, .mipmaps = volume ? MipFilter::kNone : MipFilter::kBox});
      EXPECT_EQ(imageMagick("x.dds", format == std::string("l8") ? "gray" : "rgba"), asText(texels));
    }
}

TEST_F(OtherReaders, PicturesOfEveryDepth) {
  for (const char* format : {"l8", "la8", "rgb8", "rgba8", "l16", "la16", "rgb16", "rgba16"}) {
    const Texels texels = randomTexels(pictureOf(format, 9, 7));
    writeTexels(path("x.png"), texels);
    EXPECT_EQ(openImageIo("x.png"), storedNumbers(texels)) << format;
  }
  for (const char* format : {"l16f", "rgb16f", "rgba16f", "l32f", "rgb32f", "rgba32f"}) {
    const Texels texels = randomTexels(pictureOf(format, 9, 7));
    writeTexels(path("x.exr"), texels);
    const std::vector<float> read = openImageIo("x.exr"), expected = storedNumbers(texels);
    ASSERT_EQ(read.size(), expected.size());
    for (std::size_t i = 0; i < read.size(); ++i) EXPECT_NEAR(read[i], expected[i], 1e-6f) << format;
  }
}

TEST_F(OtherReaders, OpenImageIoAndVdbPrintReadVdb) {
  if (!hasVdb()) GTEST_SKIP() << "built without OpenVDB";
  Texels texels = randomTexels(volumeOf("r32f", 16, 8, 8));
  texels.notes.name = "density";
  texels.notes.voxelSizeM = {20.0, 20.0, 10.0};
  texels.notes.firstVoxelM = {0.0, 0.0, 600.0};
  texels.notes.metadata["author"] = "a test";
  writeVdb(path("x.vdb"), texels);
  const std::string print = outputOf("vdb_print -l " + path("x.vdb"));
  for (const char* line :
       {"Name: density\n", "Type: Tree_float_5_4_3\n", "Number of active voxels:       1,024\n",
        "Dimensions of active voxels:   16 x 8 x 8\n", "author: a test\n", "class: fog volume\n",
        "file_compression: blosc + active values\n", "is_saved_as_half_float: false\n", "[20, 0, 0, 0]",
        "[0, 20, 0, 0]", "[0, 0, 10, 0]", "[0, 0, 600, 1]"})
    EXPECT_NE(print.find(line), std::string::npos) << line << "\n" << print;

  // OpenImageIO's box has a margin.
  std::istringstream lines(outputOf("timeout 60 oiiotool --dumpdata " + path("x.vdb")));
  std::string line;
  int found = 0;
  while (std::getline(lines, line)) {
    int x = 0, y = 0, z = 0;
    float value = 0.0f;
    if (std::sscanf(line.c_str(), " Pixel (%d, %d, %d): %f", &x, &y, &z, &value) != 4) continue;
    if (x >= 16 || y >= 8 || z >= 8) continue;
    EXPECT_NEAR(value, texels.value(x, y, z), 1e-6f);
    ++found;
  }
  EXPECT_EQ(found, 16 * 8 * 8);
}

}  // namespace
}  // namespace welkin::io
