// SPDX-License-Identifier: Apache-2.0
// Readers of files that nobody vouches for: cut short at every byte, with every byte changed, with sizes that
// no file has. Each gives an IoError, or texels, and asks for no more memory than the file could fill.
#include <sys/resource.h>

#include "scratch.h"
#include "some_texels.h"
#include "welkin/io/raw.h"
#include "welkin/io/texel_file.h"
#include "welkin/io/vdb.h"

// The sanitizers keep terabytes of address space for themselves, and are slow: they see some of the files.
#ifdef __has_feature
#define WELKIN_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#else
#define WELKIN_SANITIZED 0
#endif

// OpenVDB forgets the node that it is reading when a chunk of values turns out to be damaged.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:openvdb::";
}

namespace welkin::io {
namespace {

class UntrustedFiles : public Scratch {
 protected:
  // True if it was read, false after an IoError that names the file. All else fails the test.
  bool reads(const std::filesystem::path& path, const std::string& bytes) const {
    // A file written anew over itself goes to the disk at once, on file systems that guard against losing
    // both.
    std::filesystem::remove(path);
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    try {
      readTexels(path);
      return true;
    } catch (const IoError& e) {
      const bool named = std::string(e.what()).find(folder.string()) != std::string::npos;
      EXPECT_TRUE(named) << e.what();
    }
    return false;
  }

  // Small files of every kind: name and bytes of one that is good.
  std::vector<std::pair<std::string, std::string>> smallFiles() const {
    std::vector<std::pair<std::string, std::string>> files;
    const auto add = [&](const char* name, const Texels& texels, const DdsOptions& dds = {}) {
      writeTexels(folder / name, texels, dds);
      files.emplace_back(name, contents(folder / name));
    };
    add("l8.png", randomTexels(pictureOf("l8", 7, 5)));
    add("rgba16.png", randomTexels(pictureOf("rgba16", 5, 3)));
    add("rgb16f.exr", randomTexels(pictureOf("rgb16f", 6, 5)));
    add("l32f.exr", randomTexels(pictureOf("l32f", 9, 40)));
    add("flat.hdr", randomTexels(pictureOf("rgb32f", 5, 3)));
    add("coded.hdr", randomTexels(pictureOf("rgb32f", 12, 3)));
    add("l8.dds", randomTexels(pictureOf("l8", 7, 5)),
        {.header = DdsHeader::kAuto, .mipmaps = MipFilter::kBox});
    add("volume.dds", randomTexels(volumeOf("rgba16f", 3, 4, 5)), {.header = DdsHeader::kDx10});
    add("volume.raw", randomTexels(volumeOf("r16f", 3, 4, 5)));
    if (hasVdb()) add("float.vdb", randomTexels(volumeOf("r32f", 9, 3, 2)));
    return files;
  }
};

TEST_F(UntrustedFiles, CutShortAtEveryByte) {
  for (const auto& [name, good] : smallFiles()) {
    ASSERT_TRUE(reads(folder / name, good)) << name;
    const bool large = name.ends_with(".vdb");
    for (std::size_t n = 0; n < good.size(); n += large && WELKIN_SANITIZED ? 13 : 1)
      EXPECT_FALSE(reads(folder / name, good.substr(0, n))) << name << " of " << n << " bytes";
  }
}

TEST_F(UntrustedFiles, EveryByteChanged) {
  for (const auto& [name, good] : smallFiles())
    for (std::size_t at = 0; at < good.size(); ++at) {
      // A VDB is mostly masks that are zero: some of those.
      if (name.ends_with(".vdb") && good[at] == '\0' && at % 61 != 0) continue;
      for (const int change : {0xff, 0x80, 0x01}) {
        if (WELKIN_SANITIZED && change == 0x01) continue;
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ change);
        reads(folder / name, bad);
      }
    }
}

TEST_F(UntrustedFiles, SideFilesCutShortAndWrong) {
  const std::filesystem::path path = folder / "x.raw", sidePath = rawSidePath(path);
  writeTexels(path, randomTexels(volumeOf("r16f", 3, 4, 5)));
  const std::string texels = contents(path), side = contents(sidePath);
  const auto refusal = [&](const std::string& text) {
    std::ofstream(sidePath, std::ios::binary) << text;
    const std::string message = messageOf<IoError>([&] { readTexels(path); });
    return message.substr(message.find(": ") + 2);
  };
  for (std::size_t n = 0; n + 1 < side.size(); ++n)
    refusal(side.substr(0, n));  // the last byte is a line feed
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = side;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refusal(text.replace(at, from.size(), to));
  };
  EXPECT_EQ(with("{", "["), "no JSON (byte 13)");
  EXPECT_EQ(with("\"version\": 1", "\"version\": 2"), "version: expected 1");
  EXPECT_EQ(with("float16", "float64"),
            "type: expected uint8, uint16, float16 or float32, found \"float64\"");
  EXPECT_EQ(with("    3,", "    2147483648,"),
            "size: expected whole numbers of at least 1, found 2147483648");
  EXPECT_EQ(with("    3,", "    -3,"), "size: expected whole numbers of at least 1, found -3");
  EXPECT_EQ(with("    3,", "    3.5,"), "size: expected whole numbers of at least 1, found 3.5");
  EXPECT_EQ(with("    3,", "    NaN,"), "no JSON (byte 34)");
  EXPECT_EQ(with("    3,", "    2147483647,").substr(0, 22), "the file has 120 bytes");
  EXPECT_EQ(with("    3,\n    4,\n    5", "    2147483647,\n    2147483647,\n    2147483647"),
            "2147483647x2147483647x2147483647 texels are more than can be counted");
  EXPECT_EQ(with("\"channels\"", "\"chanels\""), "there is no \"channels\"");
  EXPECT_EQ(with("\"byte_order\"", "\"seed\": 7, \"byte_order\""), "unknown key \"seed\"");
  EXPECT_EQ(with("voxel_size_m\": [\n    1.0", "voxel_size_m\": [\n    -1.0"),
            "voxel_size_m: expected three positive numbers, found -1.0");
  EXPECT_EQ(with("voxel_size_m\": [\n    1.0", "voxel_size_m\": [\n    1e999").substr(0, 7), "no JSON");
  std::string deep(200000, '[');
  EXPECT_EQ(refusal(deep).substr(0, 7), "no JSON");
  deep += std::string(200000, ']');
  EXPECT_EQ(refusal("{\"version\": " + deep + "}"), "version: expected 1");
  EXPECT_EQ(
      refusal("{\"version\": 1, \"byte_order\": \"little\", \"size\": [1, 1], \"channels\": " + deep + "}"),
      "channels: expected a, l, r, la, rgb or rgba, found a list");
  EXPECT_EQ(refusal(std::string((1 << 20) + 1, ' ')), "a side file of more than 1 MiB");
  std::ofstream(sidePath, std::ios::binary) << side;
  std::ofstream(path, std::ios::binary) << texels << "x";
  EXPECT_EQ(messageOf<IoError>([&] { readTexels(path); }),
            "cannot read " + path.string() + ": the file has 121 bytes; " + sidePath.string() + " says 120");
}

// Headers that promise pictures of many gigabytes; under a limit of address space that leaves room for none
// of them.
TEST_F(UntrustedFiles, AbsurdSizesAskForNoMemory) {
  const auto u32 = [](std::uint32_t x) { return std::string(reinterpret_cast<const char*>(&x), 4); };
  std::vector<std::pair<std::string, std::string>> files;
  files.emplace_back("narrow.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2147483647 +X 1\n");
  files.emplace_back("wide.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 30000\nabcd");
  files.emplace_back("over.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999999999999999 +X 1\nabcd");
  writeTexels(folder / "a.png", randomTexels(pictureOf("rgba16", 3, 3)));
  std::string png = contents(folder / "a.png").substr(0, 16);
  png += std::string("\0\0\xff\xff\0\0\xff\xff\x10\6\0\0\0", 13) +
         "\xe6\x95\x05\x13";  // 65535 x 65535 of 64 bits
  files.emplace_back("huge.png", png);
  // An EXR of 2^31 - 1 rows, and one of as many columns.
  writeTexels(folder / "a.exr", randomTexels(pictureOf("l16f", 3, 3)));
  for (const std::size_t which : {8u, 12u}) {
    std::string exr = contents(folder / "a.exr");
    const std::size_t at = exr.find("dataWindow") + 11 + 6 + 4 + which;
    exr.replace(at, 4, u32(0x7ffffffe));
    files.emplace_back("huge.exr", exr);
    exr.replace(at, 4, u32(60000));
    files.emplace_back("large.exr", exr);
  }
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit tight = before;
  tight.rlim_cur = std::size_t{4} << 30;
  if (!WELKIN_SANITIZED) setrlimit(RLIMIT_AS, &tight);
  for (const auto& [name, bytes] : files) EXPECT_FALSE(reads(folder / name, bytes)) << name;
  setrlimit(RLIMIT_AS, &before);
}

TEST_F(UntrustedFiles, FoldersPipesAndMissingFiles) {
  for (const char* name : {"x.png", "x.exr", "x.hdr", "x.dds", "x.raw", "x.vdb"}) {
    EXPECT_THROW(readTexels(folder / name), IoError) << name;
    std::filesystem::create_directory(folder / name);
    EXPECT_THROW(readTexels(folder / name), IoError) << name;
  }
  EXPECT_EQ(messageOf<IoError>([&] { readTexels(folder / "x.dds"); }),
            "cannot read " + (folder / "x.dds").string() + ": is a folder");
}

}  // namespace
}  // namespace welkin::io
