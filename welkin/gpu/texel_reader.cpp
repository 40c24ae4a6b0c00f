// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/texel_reader.h"

#include <epoxy/gl.h>

namespace welkin::gpu {

TexelReader::TexelReader() {
  glGenSamplers(1, &sampler_);
  const auto set = [this](GLenum name, GLenum value) {
    glSamplerParameteri(sampler_, name, static_cast<GLint>(value));
  };
  set(GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  set(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  set(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  set(GL_TEXTURE_COMPARE_MODE, GL_NONE);
}

TexelReader::~TexelReader() {
  glDeleteSamplers(1, &sampler_);
}

TexelReader::Binding::Binding(const TexelReader& reader, const Program& program, std::string_view sampler,
                              unsigned texture)
    : unit_(texture ? program.unitOf(sampler) : -1) {
  if (unit_ < 0) return;
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit_));
  glBindTexture(GL_TEXTURE_2D, texture);
  glActiveTexture(GL_TEXTURE0);
  glBindSampler(static_cast<GLuint>(unit_), reader.sampler_);
}

TexelReader::Binding::~Binding() {
  if (unit_ >= 0) glBindSampler(static_cast<GLuint>(unit_), 0);
}

}  // namespace welkin::gpu
