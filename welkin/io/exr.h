// SPDX-License-Identifier: Apache-2.0
// OpenEXR scan-line pictures of linear light, ZIP compressed, with channels Y, RGB or RGBA.
//
// Files carry the chromaticities of Rec. 709 and whiteLuminance = 1 cd/m2, the OpenEXR attribute that says
// that pixel values are cd/m2. The same picture gives the same bytes whatever the number of threads.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/image.h"
#include "welkin/io/texels.h"

namespace welkin::io {

enum class ExrDepth {
  kAuto,   // half, but float when a value is beyond half's 65504: the sun's disc is 1.6e9 cd/m2
  kHalf,   // values beyond +-65504 are clamped
  kFloat,  // as they are
};

struct ExrOptions {
  ExrDepth depth = ExrDepth::kAuto;
  std::map<std::string, std::string> metadata;  // further text attributes
};

// 1, 3 or 4 channels. The file appears complete or not at all. Throws IoError; ParameterError for NaNs and
// infinities (naming the pixel), other channel counts, no pixels or more than 65536 a side, or metadata named
// like an attribute of the format.
void writeExr(const std::filesystem::path& path, const Image<float>& image, const ExrOptions& options = {});

struct ExrPicture {
  Image<float> image;  // the data window: Y, RGB or RGBA
  bool half = false;   // how it was stored
  std::map<std::string, std::string> metadata;
};

// Throws IoError for what is missing, damaged, no EXR, has neither Y nor R, G and B, several parts,
// or more than 65536 pixels a side.
ExrPicture readExr(const std::filesystem::path& path);
// The same as it is stored: l, rgb or rgba of halves, or of floats unless all channels are halves.
Texels readExrTexels(const std::filesystem::path& path);

// Planes of 32-bit floats by name, of any number and of any names that the format has: what other programs
// show as layers.
struct ExrPlanes {
  int width = 0, height = 0;
  // One at least, each of all pixels row by row from the top.
  std::map<std::string, std::vector<float>> planes;
  std::map<std::string, std::string> metadata;
  bool half = false;  // writes halves, values beyond their range clamped; after reading: all were
};
// Throws as writeExr(), and ParameterError for no planes and for those of another size.
void writeExrPlanes(const std::filesystem::path& path, const ExrPlanes& planes);
ExrPlanes readExrPlanes(const std::filesystem::path& path);  // throws as readExr()

}  // namespace welkin::io
