// SPDX-License-Identifier: Apache-2.0
// Texels for the tests of files.
#pragma once

#include <vector>

#include "welkin/core/random.h"
#include "welkin/io/texels.h"

namespace welkin::io {

inline TexelShape pictureOf(const char* format, int nx, int ny) {
  return {texelFormat(format), nx, ny, 1, false};
}
inline TexelShape volumeOf(const char* format, int nx, int ny, int nz) {
  return {texelFormat(format), nx, ny, nz, true};
}

// Independent values in [0, 1); integers of all bits.
inline Texels randomTexels(const TexelShape& shape) {
  Texels texels(shape);
  Random random(static_cast<std::uint64_t>(shape.bytes()));
  std::vector<float> values(shape.bytes() / bytesOf(shape.format.type));
  for (float& x : values) x = random.uniform();
  fromFloats(values, shape.format.type, texels.bytes);
  return texels;
}

}  // namespace welkin::io
