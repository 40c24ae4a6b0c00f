// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948) of 8 and 16 bits a channel: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA. The same picture
// gives the same bytes on one machine's libpng and zlib.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "welkin/core/error.h"
#include "welkin/core/image.h"

namespace welkin::io {

// Keyword (1 to 79 characters of Latin-1) and text, "Software" for instance, both UTF-8 here: in tEXt chunks,
// which are Latin-1, or iTXt what is not ASCII.
using PngTexts = std::map<std::string, std::string>;

// The file appears complete or not at all. Throw IoError, and ParameterError for a picture without pixels or
// of more channels, and for keywords and texts that PNG cannot hold. `srgb`: the file says that its values
// are sRGB, as those of a picture for a screen are; other values it must not say it of.
void writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image, const PngTexts& texts = {},
              bool srgb = true);
void writePng(const std::filesystem::path& path, const Image<std::uint16_t>& image,
              const PngTexts& texts = {}, bool srgb = true);

// Palettes and fewer bits are expanded to 8. `texts` gets the texts if it is not null, `srgb` whether the
// file says that it is. Throws IoError for what is missing, damaged or no PNG.
using PngImage = std::variant<Image<std::uint8_t>, Image<std::uint16_t>>;
PngImage readPng(const std::filesystem::path& path, PngTexts* texts = nullptr, bool* srgb = nullptr);

}  // namespace welkin::io
