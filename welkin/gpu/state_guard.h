// SPDX-License-Identifier: Apache-2.0
// For drawing in the middle of somebody else's frame: keeps their OpenGL state and gives it back.
#pragma once

#include <memory>

namespace welkin::gpu {

// While it lives the context is in the state that this folder's draws expect, that of a fresh context but for
// cube maps, which are filtered across their edges. When it goes, everything that these draws change is as it
// was: program, vertex array, buffers, framebuffers, every viewport and scissor, blending and colour mask of
// every draw buffer, depth, stencil, culling, clipping, sample coverage, primitive restart, texture units 0
// to kUnits - 1 with their samplers, image units 0 and 1 where there are any, pixel storage. The context must
// stay current. Allocates nothing. Whether sRGB is encoded stays as it is: no framebuffer of this folder's
// has such pixels, and those of others mean it.
class StateGuard {
 public:
  // Of textures, of which a program leaves the first free. OpenGL 3.3 has 48 in all stages together, but
  // promises a stage no more than 16; what a program may have on a device, Program says.
  static constexpr int kUnits = 32;

  StateGuard();  // throws as requireCurrent()
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
  struct DrawBuffer {
    bool blends;
    int source[2], target[2], equation[2];  // colour, alpha
    unsigned char mask[4];
  };
  struct Viewport {
    float area[4];
    int scissor[4];
    bool cuts;
  };
  struct Stencil {
    int function, reference, mask, fail, depthFail, pass;
  };
  static constexpr int kImageUnits = 2, kDrawBuffers = 8, kViewports = 16, kClipDistances = 8, kSwitches = 13,
                       kPixelStores = 16;

  void keepDrawBuffers();
  void keepViewports();
  void keepTextures();
  void setFresh() const;
  void restoreDrawBuffers() const;
  void restoreViewports() const;
  void restoreTextures() const;

  int version_;  // of OpenGL, major * 10 + minor
  bool hasClipControl_;
  int drawBuffers_, viewports_, clipDistances_;  // how many of them there are
  int program_, vertexArray_, arrayBuffer_, packBuffer_, unpackBuffer_, drawFramebuffer_, readFramebuffer_;
  int activeTexture_, polygonMode_, clipOrigin_, clipDepth_;
  DrawBuffer buffers_[kDrawBuffers];
  Viewport areas_[kViewports];
  Stencil stencil_[2];  // of front and back faces
  unsigned char depthMask_;
  bool enabled_[kSwitches], clips_[kClipDistances], seamless_;
  int pixelStore_[kPixelStores];
  Unit units_[kUnits];
  ImageUnit images_[kImageUnits];
};

}  // namespace welkin::gpu
