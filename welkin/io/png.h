// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948) of 8 and 16 bits a channel: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA. Pictures are
// marked as sRGB. The same picture gives the same bytes on one machine's libpng and zlib.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "welkin/core/error.h"
#include "welkin/core/image.h"

namespace welkin::io {

// Keyword (1 to 79 characters) and text, "Software" for instance, in tEXt chunks, or iTXt what is not ASCII.
using PngTexts = std::map<std::string, std::string>;

// The file appears complete or not at all. Throw IoError, and ParameterError for a picture without pixels or
// of more channels, and for keywords and texts that PNG cannot hold.
void writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image,
              const PngTexts& texts = {});
void writePng(const std::filesystem::path& path, const Image<std::uint16_t>& image,
              const PngTexts& texts = {});

// Palettes and fewer bits are expanded to 8. `texts` gets the texts if it is not null. Throws IoError for
// what is missing, damaged or no PNG.
using PngImage = std::variant<Image<std::uint8_t>, Image<std::uint16_t>>;
PngImage readPng(const std::filesystem::path& path, PngTexts* texts = nullptr);

}  // namespace welkin::io
