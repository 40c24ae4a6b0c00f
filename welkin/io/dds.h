// SPDX-License-Identifier: Apache-2.0
// DirectDraw surfaces (.dds): uncompressed pictures and volumes with mipmaps. "Programming Guide for DDS",
// Microsoft; the header's fields and DXGI's numbers are from there.
//
// Written are headers of the old kind, which are what other programs read: l8, a8, la8 and l16 by masks,
// rgba8 as BGRA, volumes with DDSCAPS2_VOLUME, and by the numbers 111, 113, 114 and 116 in place of a
// four-character code r16f, rgba16f, r32f and rgba32f. With the DX10 header, which few read: r8, r16, rgba16,
// rgb32f, because only it has them, and on request a8, rgba8, r16f, rgba16f, r32f and rgba32f.
//
// Texels stand in the order of texels.h, level after level, the largest first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/io/mipmaps.h"
#include "welkin/io/texel_writer.h"
#include "welkin/io/texels.h"

namespace welkin::io {

enum class DdsHeader : std::uint8_t {
  kAuto,  // the old kind, and DX10 for formats that only it can name
  kDx10,  // with DXGI's number: read by Direct3D's own tools and few others
};

struct DdsOptions {
  DdsHeader header = DdsHeader::kAuto;
  MipFilter mipmaps = MipFilter::kNone;
  MipEdges edges = MipEdges::kClamp;
};

// True if texels of that format can be written with that header.
bool ddsHolds(TexelFormat format, DdsHeader header = DdsHeader::kAuto);
// True for the formats that the old kind of header can name.
bool legacyDdsHolds(TexelFormat format);

// Needs the memory of one slice, and with mipmaps of about 14 slices of floats. Mipmaps need a file that can
// be sought in. The same texels give the same bytes.
class DdsWriter : public TexelWriter {
 public:
  // Throws ParameterError for a format that DDS does not hold (the message names those that it does), IoError
  // if nothing can be written there.
  DdsWriter(const std::filesystem::path& path, const TexelShape& shape, const DdsOptions& options = {});
  ~DdsWriter() override;
  void write(std::span<const std::byte> rows) override;
  void close() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

void writeDds(const std::filesystem::path& path, const Texels& texels, const DdsOptions& options = {});

// Read are all that is written; RGBA8 and other orders of 8-bit channels, BGRX8, 24 bits, packed colour of 16
// bits (expanded to 8 a channel); with the DX10 header R8, A8, R16, RGBA8 and BGRA8 (sRGB too, as they are),
// BGRX8, RGBA16, R16F, RGBA16F, R32F, RGB32F, RGBA32F. Block compression, cube maps, arrays and all else are
// refused by name. OpenSceneGraph writes 16-bit luminance with the mask of 8 bits; that is read as 16.
//
// A header is believed only as far as the file is long: no more memory is asked for than the texels need.
// Throws IoError with the byte where the trouble is.
Texels readDds(const std::filesystem::path& path);                     // the largest level
std::vector<Texels> readDdsLevels(const std::filesystem::path& path);  // with mipmaps, the largest first

// What the header says, without reading texels.
struct DdsInfo {
  TexelShape shape;          // as it would be read
  std::string layout;        // as it is stored: "BGRA8", "L8", "R32F", ...
  bool dx10 = false;         // which header it has
  int levels = 1;            // mipmaps, the largest included
  std::uint64_t offset = 0;  // of the first texel in the file
};
DdsInfo readDdsInfo(const std::filesystem::path& path);

}  // namespace welkin::io
