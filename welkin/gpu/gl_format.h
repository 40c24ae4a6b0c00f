// SPDX-License-Identifier: Apache-2.0
// Translations to GL's numbers, for this folder's sources only.
#pragma once

#include <epoxy/gl.h>

#include <cassert>

#include "welkin/gpu/texture.h"

namespace welkin::gpu {

inline GLenum internalFormat(Format format) {
  switch (format) {
    case Format::kR8:
      return GL_R8;
    case Format::kRgba8:
      return GL_RGBA8;
    case Format::kR16F:
      return GL_R16F;
    case Format::kRg16F:
      return GL_RG16F;
    case Format::kRgba16F:
      return GL_RGBA16F;
    case Format::kR32F:
      return GL_R32F;
    case Format::kRgba32F:
      return GL_RGBA32F;
  }
  return GL_NONE;
}

// The layout of client memory with 1 to 4 interleaved channels.
inline GLenum clientFormat(int channels) {
  assert(channels >= 1 && channels <= 4);
  constexpr GLenum kFormats[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
  return kFormats[channels - 1];
}

}  // namespace welkin::gpu
