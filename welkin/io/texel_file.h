// SPDX-License-Identifier: Apache-2.0
// Texels by the extension of the file's name: .png .exr .hdr .dds .raw .vdb, in upper or lower case.
//
// | | picture | volume | holds |
// |---|---|---|---|
// | .png | yes | | l, la, rgb, rgba of 8 and 16 bits |
// | .exr | yes | | l, rgb, rgba of halves and floats |
// | .hdr | yes | | rgb of floats, as RGBE: 8 bits of mantissa |
// | .dds | yes | yes | see dds.h |
// | .raw | yes | yes | everything |
// | .vdb | | yes | one channel of halves and floats; 8 bits go into halves, 16 into floats |
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "welkin/io/dds.h"
#include "welkin/io/texel_writer.h"
#include "welkin/io/texels.h"

namespace welkin::io {

enum class TexelFileKind : std::uint8_t { kPng, kExr, kHdr, kDds, kRaw, kVdb };

// By extension; "x.raw.json" is RAW. Throws ParameterError that names the known ones.
TexelFileKind texelFileKindOf(const std::filesystem::path& path);

// True if texels of that shape can be handed to a writer of that kind.
bool holds(TexelFileKind kind, const TexelShape& shape, const DdsOptions& dds = {});

// What comes nearest to the shape's format without losing anything, or nothing if there is none: a picture of
// rgb8 becomes rgba8 in a DDS, one of r32f becomes l32f in an EXR. In a DDS names that more programs read go
// before: r8 becomes l8.
std::optional<TexelFormat> nearestFormat(TexelFileKind kind, const TexelShape& shape,
                                         const DdsOptions& dds = {});

// A writer for one file. DDS and RAW stream; VDB keeps what is not zero, pictures are kept whole until
// close(). Throws ParameterError for a shape that the kind does not hold, IoError if nothing can be written
// there.
std::unique_ptr<TexelWriter> createTexelFile(const std::filesystem::path& path, const TexelShape& shape,
                                             const TexelNotes& notes = {}, const DdsOptions& dds = {});

// The same in one step.
void writeTexels(const std::filesystem::path& path, const Texels& texels, const DdsOptions& dds = {});

// The largest level of a DDS, the density of a VDB. Pictures come in the format that they are stored in;
// values are as they stand in the file, without any transfer function. Throws IoError, also for NaNs and
// infinities.
Texels readTexels(const std::filesystem::path& path);

}  // namespace welkin::io
