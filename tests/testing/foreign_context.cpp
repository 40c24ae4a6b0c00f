// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/foreign_context.h"

#include <epoxy/egl.h>

namespace welkin::testing {

struct ForeignContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

ForeignContext::ForeignContext() : handles_(std::make_unique<Handles>()) {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) return;
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) return;
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) return;
  handles_->display = display;
  handles_->context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  makeCurrent();
}

ForeignContext::~ForeignContext() {
  if (!works()) return;
  if (isCurrent()) release();
  eglDestroyContext(handles_->display, handles_->context);
}

bool ForeignContext::works() const {
  return handles_->context != EGL_NO_CONTEXT;
}
bool ForeignContext::isCurrent() const {
  return eglGetCurrentContext() == handles_->context;
}
bool ForeignContext::makeCurrent() const {
  return eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles_->context);
}
void ForeignContext::release() const {
  eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace welkin::testing
