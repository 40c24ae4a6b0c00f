// SPDX-License-Identifier: Apache-2.0
// Somewhere to draw to: colour attachments that are textures or slices of a volume, all of one size.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>

#include "welkin/core/image.h"
#include "welkin/gpu/texture.h"

namespace welkin::gpu {

class Framebuffer {
 public:
  static constexpr int kMaxAttachments = 4;

  Framebuffer();
  explicit Framebuffer(const Texture2D& colour);  // the texture as attachment 0
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;
  Framebuffer(Framebuffer&& other) noexcept;
  Framebuffer& operator=(Framebuffer&& other) noexcept;

  // Fragment output `index` (0 to 3) goes to this texture, or to slice z of this volume. The texture must
  // outlive the use.
  void attach(int index, const Texture2D& texture);
  void attachSlice(int index, const Texture3D& volume, int z);

  unsigned id() const { return id_; }  // the GL name
  int width() const { return width_; }
  int height() const { return height_; }

  // A number for every pixel, one channel, top row first: draws with DrawOptions::where go where theirs is.
  // Devices leave out the others before they run the program for them, in groups of a few pixels each way.
  void setMask(const Image<std::uint8_t>& mask);

  // Makes it the target of draws, over its whole size. Throws GpuError if the device cannot draw to it.
  void bind() const;
  // The same for any framebuffer by its GL name (0: the window's) and a part of it.
  static void bindArea(unsigned name, int x, int y, int width, int height);
  // Fills an attachment with one value. Binds.
  void clear(int index = 0, const glm::vec4& value = glm::vec4(0.0f)) const;

  // An attachment as a picture, top row first: fragments of the highest gl_FragCoord.y come first. Waits for
  // the device. Binds.
  Image<float> readPicture(int index = 0, int channels = 4) const;

 private:
  void attached(int index, int width, int height);

  unsigned id_ = 0;
  int width_ = 0, height_ = 0;
  unsigned used_ = 0;  // bit i: attachment i is there
  unsigned mask_ = 0;  // GL name of the mask's texture
};

}  // namespace welkin::gpu
