// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/texture.h"

#include <algorithm>
#include <string>
#include <utility>

#include "welkin/core/error.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {
namespace {

GLint glWrap(Wrap wrap) {
  return wrap == Wrap::kRepeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
}

void setAnisotropy(GLenum target, float wanted) {
  if (!epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) return;
  GLfloat most = 1.0f;
  glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
  glTexParameterf(target, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(wanted, most));
}

// Whether a level of the texture that is bound was made, all levels before it being so: one that was refused
// has no size. OpenGL's errors do not tell, as there may be an engine's among them, which are its own to
// read.
bool has(GLenum target, int level) {
  GLint width = 0;
  glGetTexLevelParameteriv(target == GL_TEXTURE_CUBE_MAP ? GL_TEXTURE_CUBE_MAP_NEGATIVE_Z : target, level,
                           GL_TEXTURE_WIDTH, &width);
  return width > 0;
}

int levelCount(int width, int height, int depth) {
  int levels = 1;
  for (int n = std::max({width, height, depth}); n > 1; n /= 2) ++levels;
  return levels;
}

}  // namespace

int channelsOf(Format format) {
  switch (format) {
    case Format::kR8:
    case Format::kR16F:
    case Format::kR32F:
      return 1;
    case Format::kRg16F:
      return 2;
    default:
      return 4;
  }
}

float affordableAnisotropy(float wanted) {
  // llvmpipe walks along the footprint texel by texel, each with a filter of its own.
  return isSoftware() ? 1.0f : wanted;
}

Texture::Texture(unsigned target, int width, int height, int depth, const TextureOptions& options)
    : target_(target), width_(width), height_(height), depth_(depth), options_(options) {
  const bool volume = target == GL_TEXTURE_3D, cube = target == GL_TEXTURE_CUBE_MAP;
  GLint largest = 0;
  glGetIntegerv(volume ? GL_MAX_3D_TEXTURE_SIZE
                : cube ? GL_MAX_CUBE_MAP_TEXTURE_SIZE
                       : GL_MAX_TEXTURE_SIZE,
                &largest);
  if (std::min({width, height, depth}) < 1 || std::max({width, height, depth}) > largest)
    throw GpuError("a texture of " + std::to_string(width) + " x " + std::to_string(height) +
                   (volume ? " x " + std::to_string(depth) : "") +
                   " texels cannot be made; this device does 1 to " + std::to_string(largest) + " a side");

  glGenTextures(1, &id_);
  glBindTexture(target, id_);
  const bool mipmap = options.filter == Filter::kMipmap;
  const GLint magnified = options.filter == Filter::kNearest ? GL_NEAREST : GL_LINEAR;
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, mipmap ? GL_LINEAR_MIPMAP_LINEAR : magnified);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, magnified);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, glWrap(options.wrapX));
  glTexParameteri(target, GL_TEXTURE_WRAP_T, glWrap(options.wrapY));
  if (volume) glTexParameteri(target, GL_TEXTURE_WRAP_R, glWrap(options.wrapZ));
  if (mipmap && options.anisotropy > 1.0f) setAnisotropy(target, options.anisotropy);

  // glTexStorage is GL 4.2; level by level works everywhere.
  const int levels = mipmap ? levelCount(width, height, depth) : 1;
  glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, levels - 1);
  const GLint format = static_cast<GLint>(internalFormat(options.format));
  const GLenum client = clientFormat(channelsOf(options.format));
  const bool bytes = options.format == Format::kR8 || options.format == Format::kRgba8;
  const GLenum type = bytes ? GL_UNSIGNED_BYTE : GL_FLOAT;
  for (int level = 0; level < levels; ++level) {
    const int w = std::max(width >> level, 1), h = std::max(height >> level, 1),
              d = std::max(depth >> level, 1);
    if (volume)
      glTexImage3D(target, level, format, w, h, d, 0, client, type, nullptr);
    else if (cube)
      for (GLenum face = 0; face < 6; ++face)
        glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, level, format, w, h, 0, client, type, nullptr);
    else
      glTexImage2D(target, level, format, w, h, 0, client, type, nullptr);
  }
  if (!has(target, levels - 1)) {
    const GLenum error = glGetError();
    glDeleteTextures(1, &id_);
    throw GpuError("a texture of " + std::to_string(width) + " x " + std::to_string(height) +
                   (volume ? " x " + std::to_string(depth) : "") + " texels was refused: " +
                   (error == GL_OUT_OF_MEMORY ? "out of memory" : "GL error " + std::to_string(error)));
  }
}

Texture::~Texture() {
  if (id_) glDeleteTextures(1, &id_);
}

Texture::Texture(Texture&& other) noexcept {
  *this = std::move(other);
}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(target_, other.target_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(depth_, other.depth_);
  std::swap(options_, other.options_);
  return *this;
}

void Texture::makeMipmaps() {
  if (options_.filter != Filter::kMipmap) return;
  glBindTexture(target_, id_);
  glGenerateMipmap(target_);
}

void Texture::uploadValues(std::span<const float> values, int channels, int face) {
  assert(values.size() == static_cast<std::size_t>(width_) * height_ * depth_ * channels);
  glBindTexture(target_, id_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (target_ == GL_TEXTURE_3D)
    glTexSubImage3D(target_, 0, 0, 0, 0, width_, height_, depth_, clientFormat(channels), GL_FLOAT,
                    values.data());
  else
    glTexSubImage2D(
        target_ == GL_TEXTURE_CUBE_MAP ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face) : target_,
        0, 0, 0, width_, height_, clientFormat(channels), GL_FLOAT, values.data());
}

void Texture::readValues(std::span<float> values, int channels) const {
  assert(values.size() == static_cast<std::size_t>(width_) * height_ * depth_ * channels);
  glBindTexture(target_, id_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(target_, 0, clientFormat(channels), GL_FLOAT, values.data());
}

Texture2D::Texture2D(int width, int height, const TextureOptions& options)
    : Texture(GL_TEXTURE_2D, width, height, 1, options) {}

Texture2D::Texture2D(const Image<float>& image, const TextureOptions& options)
    : Texture2D(image.width, image.height, options) {
  upload(image);
  makeMipmaps();
}

void Texture2D::upload(const Image<float>& image) {
  assert(image.width == width() && image.height == height());
  uploadValues(image.data, image.channels);
}

Image<float> Texture2D::read() const {
  Image<float> image(width(), height(), channelsOf(options().format));
  readValues(image.data, image.channels);
  return image;
}

Texture3D::Texture3D(int nx, int ny, int nz, const TextureOptions& options)
    : Texture(GL_TEXTURE_3D, nx, ny, nz, options) {}

Texture3D::Texture3D(const Volume<float>& volume, const TextureOptions& options)
    : Texture3D(volume.nx, volume.ny, volume.nz, options) {
  upload(volume);
  makeMipmaps();
}

void Texture3D::upload(const Volume<float>& volume) {
  assert(volume.nx == width() && volume.ny == height() && volume.nz == depth());
  uploadValues(volume.data, volume.channels);
}

Volume<float> Texture3D::read() const {
  Volume<float> volume(width(), height(), depth(), channelsOf(options().format));
  readValues(volume.data, volume.channels);
  return volume;
}

TextureCube::TextureCube(const std::array<Image<float>, 6>& faces, const TextureOptions& options)
    : Texture(GL_TEXTURE_CUBE_MAP, faces[0].width, faces[0].height, 1, options) {
  for (int f = 0; f < 6; ++f) {
    const Image<float>& face = faces[static_cast<std::size_t>(f)];
    assert(face.width == width() && face.height == width() && face.channels == faces[0].channels);
    uploadValues(face.data, face.channels, f);
  }
  makeMipmaps();
}

}  // namespace welkin::gpu
