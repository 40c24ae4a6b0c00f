// SPDX-License-Identifier: Apache-2.0
// Texels to another format, by rules that never lose anything silently.
//
// Channels. A, L and R are names of the same one value. One value to colour: grey. Alpha that was not there
// is 1; alpha that has no place must be 1 everywhere. Colour to one value or LA must be grey: R = G = B
// everywhere. Types. Integers are value / 255 and value / 65535. To integers: to the nearest; values must lie
// in [0, 1]. To halves: to the nearest; values must lie within +-65504. What must be and is not is a
// ParameterError that names the first texel and its value.
#pragma once

#include <cstddef>
#include <span>

#include "welkin/io/texels.h"

namespace welkin::io {

// Row by row or slice by slice, so that no second copy of the whole is needed.
class TexelConverter {
 public:
  // `from` is the shape of the whole, which messages about texels refer to.
  TexelConverter(const TexelShape& from, TexelFormat to);

  // The next rows; the result stays until the next call.
  std::span<const std::byte> convert(std::span<const std::byte> rows);

 private:
  TexelShape from_, to_;
  std::size_t rowsDone_ = 0;
  std::vector<float> in_, out_;
  std::vector<std::byte> bytes_;
};

Texels convertTexels(const Texels& texels, TexelFormat to);

}  // namespace welkin::io
