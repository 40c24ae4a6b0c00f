// SPDX-License-Identifier: Apache-2.0
// Textures in the context's memory, as owners of their GL names.
//
// Row and slice order: texel (0, 0, 0) is at texture coordinate 0 and is the first of the array, so an Image
// or Volume that is uploaded is read by a shader exactly as core/glsl.h reads it on the CPU. For an Image, v
// = 0 is therefore the top row. What is drawn into a texture is read back as a picture through Framebuffer,
// which turns it over.
#pragma once

#include <array>
#include <span>

#include "welkin/core/image.h"

namespace welkin::gpu {

enum class Format { kR8, kRgba8, kR16F, kRg16F, kRgba16F, kR32F, kRgba32F };
int channelsOf(Format format);

enum class Wrap { kRepeat, kClamp };
enum class Filter {
  kNearest,
  kLinear,
  kMipmap,  // linear in and between levels; call makeMipmaps() after filling level 0
};

struct TextureOptions {
  Format format = Format::kRgba16F;
  Filter filter = Filter::kLinear;
  Wrap wrapX = Wrap::kClamp, wrapY = Wrap::kClamp, wrapZ = Wrap::kClamp;  // wrapZ: volumes only
  // Texels along the longer side of a pixel's footprint, with kMipmap; 1 where the driver lacks
  // EXT_texture_filter_anisotropic, and never more than it does.
  float anisotropy = 1.0f;
};

// The anisotropy that drawing in the current context can afford: `wanted` on a graphics card, 1 on software
// rasterisers.
float affordableAnisotropy(float wanted);

// What all kinds share. Movable; not copyable.
class Texture {
 public:
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  unsigned id() const { return id_; }          // the GL name
  unsigned target() const { return target_; }  // GL_TEXTURE_2D, _3D or _CUBE_MAP
  const TextureOptions& options() const { return options_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int depth() const { return depth_; }  // 1 for pictures

  // Fills the levels below level 0 from it; does nothing without Filter::kMipmap.
  void makeMipmaps();

 protected:
  Texture() = default;
  Texture(unsigned target, int width, int height, int depth, const TextureOptions& options);
  ~Texture();
  // width * height * depth * channels values, 1 to 4 channels; the driver converts to the texture's format.
  // face: of a cube.
  void uploadValues(std::span<const float> values, int channels, int face = 0);
  void readValues(std::span<float> values, int channels) const;

 private:
  unsigned id_ = 0, target_ = 0;
  int width_ = 0, height_ = 0, depth_ = 0;
  TextureOptions options_;
};

class Texture2D : public Texture {
 public:
  Texture2D() = default;  // no texture: for members that are filled later
  // Allocated, its contents undefined. Throws GpuError for sizes that the device does not do, or no memory;
  // only then is an OpenGL error taken that was there before.
  Texture2D(int width, int height, const TextureOptions& options = {});
  Texture2D(const Image<float>& image, const TextureOptions& options);

  // The image has the texture's size and 1 to 4 channels; missing ones become 0, missing alpha 1. Desktop GL.
  void upload(const Image<float>& image);
  // Level 0 with as many channels as the format has, first row first. Desktop GL.
  Image<float> read() const;
};

class Texture3D : public Texture {
 public:
  Texture3D() = default;
  Texture3D(int nx, int ny, int nz, const TextureOptions& options = {});
  Texture3D(const Volume<float>& volume, const TextureOptions& options);

  void upload(const Volume<float>& volume);
  Volume<float> read() const;
};

// Six square faces +x -x +y -y +z -z. Filtered across its edges inside a StateGuard.
class TextureCube : public Texture {
 public:
  TextureCube() = default;
  // All of one size, square, with the same number of channels; first row first, as OpenGL orients faces.
  TextureCube(const std::array<Image<float>, 6>& faces, const TextureOptions& options);
};

}  // namespace welkin::gpu
