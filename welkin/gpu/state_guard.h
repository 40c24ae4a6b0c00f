// SPDX-License-Identifier: Apache-2.0
// For drawing in the middle of somebody else's frame: keeps their OpenGL state and gives it back.
#pragma once

#include <memory>

namespace welkin::gpu {

// While it lives the context is in the state that this folder's draws expect, that of a fresh context but for
// cube maps, which are filtered across their edges. When it goes, everything that these draws change is as it
// was: program, vertex array, buffers, framebuffers, viewport, scissor, blending, depth, stencil, culling,
// colour mask, texture units 0 to kUnits - 1 with their samplers, image units 0 and 1 where there are any,
// pixel storage. The context must stay current. Allocates nothing.
class StateGuard {
 public:
  static constexpr int kUnits = 32;  // that programs may have; OpenGL 3.3 has 48 at least

  StateGuard();
  ~StateGuard();
  StateGuard(const StateGuard&) = delete;
  StateGuard& operator=(const StateGuard&) = delete;

 private:
  struct Unit {
    int texture2D, texture3D, textureCube, sampler;
  };
  struct ImageUnit {
    int texture, level, layered, layer, access, format;
  };
  static constexpr int kImageUnits = 2;
  int program_, vertexArray_, arrayBuffer_, packBuffer_, unpackBuffer_, drawFramebuffer_, readFramebuffer_;
  int viewport_[4], scissor_[4];
  int blendSource_[2], blendTarget_[2], blendEquation_[2];  // colour, alpha
  int packAlignment_, unpackAlignment_, unpackRowLength_, activeTexture_, polygonMode_;
  struct Stencil {
    int function, reference, mask, fail, depthFail, pass;
  };
  Stencil stencil_[2];  // of front and back faces
  unsigned char colourMask_[4], depthMask_;
  bool enabled_[8], seamless_;
  Unit units_[kUnits];
  bool hasImages_;  // from OpenGL 4.2 on
  ImageUnit images_[kImageUnits];
};

}  // namespace welkin::gpu
