// SPDX-License-Identifier: Apache-2.0
// RAW: the texels and nothing else, little-endian, in the order of texels.h; what they are stands beside in
// "<name>.raw.json":
//
//   { "version": 1, "size": [128, 128, 64], "channels": "r", "type": "float16", "byte_order": "little",
//     "voxel_size_m": [20, 20, 10], "first_voxel_m": [0, 0, 500], "name": "density",
//     "metadata": {"seed": "7"} }
//
// `size` has three numbers for a volume and two for a picture; `channels` is a, l, r, la, rgb or rgba; `type`
// is uint8, uint16, float16 or float32. All keys from "voxel_size_m" on may be missing; unknown ones are
// errors.
#pragma once

#include <filesystem>
#include <memory>

#include "welkin/io/texel_writer.h"
#include "welkin/io/texels.h"

namespace welkin::io {

// Both of either: "cloud.raw" and "cloud.raw.json".
std::filesystem::path rawTexelPath(std::filesystem::path path);
std::filesystem::path rawSidePath(const std::filesystem::path& path);

// `path` is either. Both files appear at close(), the side file last. Streams: nothing is kept in memory.
class RawWriter : public TexelWriter {
 public:
  RawWriter(const std::filesystem::path& path, const TexelShape& shape, const TexelNotes& notes = {});
  ~RawWriter() override;
  void write(std::span<const std::byte> rows) override;
  void close() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

void writeRaw(const std::filesystem::path& path, const Texels& texels);

// `path` is either. The texels' file must have exactly the size that the side file says, which is checked
// before memory is asked for. Throws IoError with the place, also for no JSON.
Texels readRaw(const std::filesystem::path& path);

}  // namespace welkin::io
