// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/write_image.h"

#include <cassert>

#include "welkin/core/error.h"
#include "welkin/io/exr.h"
#include "welkin/io/file_extension.h"
#include "welkin/io/hdr.h"
#include "welkin/io/png.h"
#include "welkin/io/quantise.h"

namespace welkin::io {

ImageFormat imageFormatOf(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  if (extension == ".png") return ImageFormat::kPng;
  if (extension == ".exr") return ImageFormat::kExr;
  if (extension == ".hdr") return ImageFormat::kHdr;
  throw ParameterError(
      path.string() + ": " +
      (extension.empty() ? "no extension" : "unknown extension " + path.extension().string()) +
      "; expected .png, .exr or .hdr");
}

void writeImage(const std::filesystem::path& path, const Image<float>& picture, const WriteOptions& options) {
  switch (imageFormatOf(path)) {
    case ImageFormat::kPng:
      assert(options.pngBits == 8 || options.pngBits == 16);
      if (options.pngBits == 16)
        writePng(path, quantise16(picture), options.metadata);
      else
        writePng(path, quantise8(picture), options.metadata);
      break;
    case ImageFormat::kExr:
      writeExr(path, picture, {.metadata = options.metadata});
      break;
    case ImageFormat::kHdr:
      writeHdr(path, picture);
      break;
  }
}

}  // namespace welkin::io
