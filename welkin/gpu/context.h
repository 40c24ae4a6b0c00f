// SPDX-License-Identifier: Apache-2.0
// An OpenGL context without a window: surfaceless EGL on a graphics card where there is one, else on Mesa's
// software rasteriser.
//
// This folder is the only one that includes GL headers, and its own headers include none. All other classes
// of the folder belong to the context that was current when they were made, and are used and destroyed while
// it is current. Nothing here is thread-safe; a context is current in one thread at a time.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/error.h"

namespace welkin::gpu {

enum class Api {
  kGl,    // desktop OpenGL, core profile, forward compatible: 4.5, else 4.3, else 3.3
  kGles,  // OpenGL ES 3.2, else 3.0: to check shaders for the web
};

struct ContextOptions {
  Api api = Api::kGl;
  bool debug = false;  // record what the driver reports as errors, see takeErrors()
};

// Whether a device is a rasteriser on the CPU, by the name that its driver gives it (GL_RENDERER).
bool isSoftwareDevice(std::string_view name);

class Context {
 public:
  // Makes the context and makes it current. Tries every hardware device, then Mesa without a surface, then
  // the default display. Throws GpuError with the reason of each failure; libraries that are missing
  // altogether are an error like any other.
  explicit Context(const ContextOptions& options = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void makeCurrent();  // in the calling thread; throws GpuError

  std::string deviceName() const;  // "llvmpipe (LLVM 15.0.6, 256 bits)", as the driver calls it
  int majorVersion() const;
  int minorVersion() const;
  bool hasCompute() const;       // desktop OpenGL 4.3 or later
  bool isSoftware() const;       // a rasteriser on the CPU: compute has no advantage over fragments there
  int maxTextureSize2D() const;  // texels a side
  int maxTextureSize3D() const;

  // What the driver has reported since the last call: errors and undefined behaviour, when made with debug;
  // glGetError always. Empty is good.
  std::vector<std::string> takeErrors();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Throws GpuError unless a context of desktop OpenGL 3.3 or more is current in the calling thread, of EGL or
// GLX: libepoxy would end the process.
void requireCurrent();

// Whichever context was current in the calling thread when it was made, somebody else's or none, is so again
// when it goes, and the bound API too.
class CurrentGuard {
 public:
  CurrentGuard();
  ~CurrentGuard();
  CurrentGuard(const CurrentGuard&) = delete;
  CurrentGuard& operator=(const CurrentGuard&) = delete;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;  // none where there is no EGL
};

}  // namespace welkin::gpu
