// SPDX-License-Identifier: Apache-2.0
// The depth texture of an engine, set up as engines do for shadows: compared, with mipmaps asked for that it
// does not have. Needs a current context; leaves no texture bound.
#pragma once

#include "welkin/core/image.h"

namespace welkin::testing {

class EngineDepthTexture {
 public:
  explicit EngineDepthTexture(const Image<float>& depth);  // in [0, 1], the bottom row first
  ~EngineDepthTexture();
  EngineDepthTexture(const EngineDepthTexture&) = delete;
  EngineDepthTexture& operator=(const EngineDepthTexture&) = delete;
  unsigned id() const { return id_; }

 private:
  unsigned id_ = 0;
};

}  // namespace welkin::testing
