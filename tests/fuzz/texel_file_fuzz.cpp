// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a file of one kind, WELKIN_FUZZ_KIND ("dds", "vdb", ...). Readers either
// throw IoError or give texels of exactly the size that their shape says. For RAW the side file goes before
// the first zero byte.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/testing/scratch_folder.h"
#include "welkin/core/error.h"
#include "welkin/io/raw.h"
#include "welkin/io/texel_file.h"
#include "welkin/io/vdb.h"

namespace {

using namespace welkin::io;

void require(bool condition) {
  if (!condition) std::abort();
}

// A file that is written anew for each input, in memory where there is /dev/shm.
std::filesystem::path scratchFile() {
  static const welkin::testing::ScratchFolder folder(
      access("/dev/shm", W_OK) == 0 ? "/dev/shm" : std::filesystem::temp_directory_path());
  return folder.path() / ("x." WELKIN_FUZZ_KIND);
}

void put(const std::filesystem::path& path, const std::uint8_t* data, std::size_t size) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size));
  close(file);
}

void check(const Texels& texels) {
  validate(texels.shape);
  require(texels.bytes.size() == texels.shape.bytes());
}

}  // namespace

// OpenVDB forgets the node that it is reading when a chunk of values turns out to be damaged.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:openvdb::";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path path = scratchFile();
  const bool raw = texelFileKindOf(path) == TexelFileKind::kRaw;
  const std::uint8_t* texels = raw ? std::find(data, data + size, std::uint8_t{0}) : data;
  if (raw) put(rawSidePath(path), data, static_cast<std::size_t>(texels - data));
  if (raw && texels != data + size) ++texels;
  put(path, texels, static_cast<std::size_t>(data + size - texels));
  try {
    if (texelFileKindOf(path) == TexelFileKind::kVdb) {  // first, as it takes more files
      const VdbSummary summary = readVdbSummary(path);
      require(summary.min <= summary.max && std::isfinite(summary.mean));
    }
    check(readTexels(path));
    if (texelFileKindOf(path) == TexelFileKind::kDds)
      for (const Texels& level : readDdsLevels(path)) check(level);
    if (texelFileKindOf(path) == TexelFileKind::kVdb) require(!readVdbGrids(path).empty());
  } catch (const welkin::IoError& e) {
    require(std::string(e.what()).starts_with("cannot read "));
  }
  return 0;
}
