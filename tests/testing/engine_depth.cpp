// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/engine_depth.h"

#include <epoxy/gl.h>

namespace welkin::testing {

EngineDepthTexture::EngineDepthTexture(const Image<float>& depth) {
  glGenTextures(1, &id_);
  glBindTexture(GL_TEXTURE_2D, id_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, depth.width, depth.height, 0, GL_DEPTH_COMPONENT,
               GL_FLOAT, depth.data.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
}

EngineDepthTexture::~EngineDepthTexture() {
  glDeleteTextures(1, &id_);
}

}  // namespace welkin::testing
