// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/framebuffer.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/gpu/gl_format.h"

namespace welkin::gpu {

Framebuffer::Framebuffer() {
  glGenFramebuffers(1, &id_);
}

Framebuffer::Framebuffer(const Texture2D& colour) : Framebuffer() {
  attach(0, colour);
}

Framebuffer::~Framebuffer() {
  if (id_) glDeleteFramebuffers(1, &id_);
  if (mask_) glDeleteTextures(1, &mask_);
}

Framebuffer::Framebuffer(Framebuffer&& other) noexcept {
  *this = std::move(other);
}

Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(used_, other.used_);
  std::swap(mask_, other.mask_);
  return *this;
}

void Framebuffer::attach(int index, const Texture2D& texture) {
  assert(index >= 0 && index < kMaxAttachments);
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index), GL_TEXTURE_2D,
                         texture.id(), 0);
  attached(index, texture.width(), texture.height());
}

void Framebuffer::attachSlice(int index, const Texture3D& volume, int z) {
  assert(index >= 0 && index < kMaxAttachments && z >= 0 && z < volume.depth());
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index), volume.id(), 0,
                            z);
  attached(index, volume.width(), volume.height());
}

void Framebuffer::attached(int index, int width, int height) {
  used_ |= 1u << index;
  width_ = width;
  height_ = height;
  GLenum buffers[kMaxAttachments];
  for (int i = 0; i < kMaxAttachments; ++i)
    buffers[i] = used_ >> i & 1u ? GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i) : GL_NONE;
  glDrawBuffers(kMaxAttachments, buffers);
}

void Framebuffer::setMask(const Image<std::uint8_t>& mask) {
  assert(mask.width == width_ && mask.height == height_ && mask.channels == 1);
  std::vector<std::uint32_t> texels(mask.data.size());  // depth above, stencil in the lowest eight bits
  for (int y = 0; y < height_; ++y)
    std::ranges::copy_n(mask.data.begin() + static_cast<std::ptrdiff_t>(mask.index(0, y)), width_,
                        texels.begin() + static_cast<std::ptrdiff_t>(mask.index(0, height_ - 1 - y)));
  if (mask_ == 0) glGenTextures(1, &mask_);
  glBindTexture(GL_TEXTURE_2D, mask_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH24_STENCIL8, width_, height_, 0, GL_DEPTH_STENCIL,
               GL_UNSIGNED_INT_24_8, texels.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, mask_, 0);
}

void Framebuffer::bindArea(unsigned name, int x, int y, int width, int height) {
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw GpuError("this device cannot draw to the framebuffer of " + std::to_string(width) + " x " +
                   std::to_string(height) + " pixels (status " + std::to_string(status) + ")");
  glViewport(x, y, width, height);
}

void Framebuffer::bind() const {
  bindArea(id_, 0, 0, width_, height_);
}

void Framebuffer::clear(int index, const glm::vec4& value) const {
  bind();
  glClearBufferfv(GL_COLOR, index, &value.x);
}

Image<float> Framebuffer::readPicture(int index, int channels) const {
  bind();
  Image<float> picture(width_, height_, channels);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, clientFormat(channels), GL_FLOAT, picture.data.data());
  const std::size_t row = static_cast<std::size_t>(width_) * channels;
  for (int y = 0; y < height_ / 2; ++y)
    std::swap_ranges(picture.data.begin() + static_cast<std::ptrdiff_t>(row * y),
                     picture.data.begin() + static_cast<std::ptrdiff_t>(row * (y + 1)),
                     picture.data.begin() + static_cast<std::ptrdiff_t>(row * (height_ - 1 - y)));
  return picture;
}

}  // namespace welkin::gpu
