// SPDX-License-Identifier: Apache-2.0
// Radiance pictures (.hdr): RGB with 8-bit mantissas and one 8-bit exponent a pixel, run-length coded.
// Greg Ward 1991, "Real Pixels", Graphics Gems II; the file format is described in Radiance's "File Formats"
// manual page.
//
// Values are written as they are, in Welkin's pictures cd/m2; Radiance itself would take them for W/(sr m2).
// Relative precision is 1/256 of a pixel's largest channel, the range up to 1.7e38. Mantissas are rounded to
// the nearest and read without Radiance's half step, as most programs do.
#pragma once

#include <filesystem>

#include "welkin/core/image.h"

namespace welkin::io {

// 3 channels (a 4th, alpha, is left out). Negative values become 0. The file appears complete or not at all.
// Throws IoError; ParameterError for NaNs and infinities (naming the pixel), other channel counts or no
// pixels. `luminance`: the header says that values are that, in cd/m2 and Rec. 709's primaries.
void writeHdr(const std::filesystem::path& path, const Image<float>& image, bool luminance = true);

// Pictures in the usual orientation (-Y +X), with or without run-length coding of the newer kind; values are
// those before the multiplications that lines of EXPOSURE= state. Throws IoError for all else.
// `luminance` gets whether the header says so as writeHdr() does.
Image<float> readHdr(const std::filesystem::path& path, bool* luminance = nullptr);

}  // namespace welkin::io
