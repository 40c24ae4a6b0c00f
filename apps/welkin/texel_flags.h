// SPDX-License-Identifier: Apache-2.0
// Flags that say what a file of texels is to be, for every command that writes one.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "command_line.h"
#include "welkin/io/texel_file.h"

namespace welkin::app {

// "1024x1024", "128x128x64": texels. Throws UsageError: 1 to 65536 an axis and 2^36 in all.
glm::ivec3 sizeOf(const std::string& text);
bool isVolume(const std::string& text);  // whether such a text has three numbers

// From --mipmaps, --edges and --header. `edges`: what mipmaps take where --edges is not given.
// Throws UsageError that begins with `command`, "noise" for instance.
io::DdsOptions ddsOptions(const std::string& command, const TexelFileFlags& flags, io::TexelFileKind kind,
                          io::MipEdges edges);

// Of a file's name. `expected`: the kinds that the command takes, for the message. Throws UsageError.
inline constexpr const char* kAnyTexelFile = ".png, .exr, .hdr, .dds, .raw or .vdb";
inline constexpr const char* kVolumeFile = ".dds, .raw or .vdb";
io::TexelFileKind fileKindOf(const std::string& command, const std::string& path,
                             const char* expected = kAnyTexelFile);

// --format, or `usual` where it is not given: for one value a texel by the name that the kind of file has for
// it. shape.format.channels says how many channels there are to be held.
io::TexelFormat formatFor(const OutputArgs& args, io::TexelFileKind kind, io::TexelShape shape,
                          const io::DdsOptions& dds);

}  // namespace welkin::app
