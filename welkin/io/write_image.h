// SPDX-License-Identifier: Apache-2.0
// Still pictures by the extension of their name.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "welkin/core/image.h"

namespace welkin::io {

enum class ImageFormat {
  kPng,  // values for a screen: sRGB-encoded, in [0, 1]
  kExr,  // linear luminance, cd/m2
  kHdr,  // the same
};

// By extension, in upper or lower case. Throws ParameterError that names the known ones.
ImageFormat imageFormatOf(const std::filesystem::path& path);

// True for formats that hold linear luminance, false for those that hold values for a screen.
constexpr bool holdsLuminance(ImageFormat format) {
  return format != ImageFormat::kPng;
}

struct WriteOptions {
  int pngBits = 8;                              // 8 (dithered) or 16
  std::map<std::string, std::string> metadata;  // PNG and EXR: key and text
};

// The picture in the meaning that its format has, see ImageFormat. Throws as the writers of the formats do.
void writeImage(const std::filesystem::path& path, const Image<float>& picture,
                const WriteOptions& options = {});

}  // namespace welkin::io
