// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <string_view>
#include <utility>

#include "welkin/core/error.h"

namespace welkin::gpu {
namespace {

// libepoxy loads the libraries at the first call and ends the process when they are missing. A library may
// not do that, so they are tried first. The handles are kept: Mesa does not survive being unloaded.
bool opens(const char* name) {
  return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

void requireLibraries(Api api) {
  const char* advice =
      "; install libegl1, libgl1, libgles2 and a driver (libegl-mesa0 draws without a graphics card)";
  if (!opens("libEGL.so.1")) throw GpuError(std::string("no EGL: libEGL.so.1 cannot be loaded") + advice);
  if (api == Api::kGl && !opens("libOpenGL.so.0") && !opens("libGL.so.1"))
    throw GpuError(std::string("no OpenGL: neither libOpenGL.so.0 nor libGL.so.1 can be loaded") + advice);
  if (api == Api::kGles && !opens("libGLESv2.so.2"))
    throw GpuError(std::string("no OpenGL ES: libGLESv2.so.2 cannot be loaded") + advice);
}

bool contains(const char* extensions, std::string_view name) {
  if (!extensions) return false;
  std::string_view list = extensions;
  while (!list.empty()) {
    const std::size_t end = list.find(' ');
    if (list.substr(0, end) == name) return true;
    list.remove_prefix(end == std::string_view::npos ? list.size() : end + 1);
  }
  return false;
}

// Extension functions are fetched by hand after a look at the extension: libepoxy ends the process when one
// is missing.
template <class Function>
Function entryPoint(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::string eglErrorName() {
  const EGLint error = eglGetError();
  static constexpr std::pair<EGLint, const char*> kNames[] = {
      {EGL_SUCCESS, "no reason given"},         {EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
      {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},       {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
      {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"}, {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
      {EGL_BAD_CONTEXT, "EGL_BAD_CONTEXT"},     {EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
      {EGL_BAD_MATCH, "EGL_BAD_MATCH"},         {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"}};
  for (const auto& [value, name] : kNames)
    if (value == error) return name;
  return "EGL error " + std::to_string(error);
}

// EGL hands out one display for equal arguments, and terminating it ends it for all its users, others than
// Welkin among them: it stays until the process ends.
bool initialise(EGLDisplay display) {
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr);
}

struct Candidate {
  std::string name;  // for messages
  EGLDisplay display = EGL_NO_DISPLAY;
};

// The displays to try, the best first.
std::vector<Candidate> candidates() {
  std::vector<Candidate> list;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto platformDisplay = contains(client, "EGL_EXT_platform_base")
                                   ? entryPoint<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT")
                                   : nullptr;
  const bool devices =
      contains(client, "EGL_EXT_platform_device") &&
      (contains(client, "EGL_EXT_device_base") || contains(client, "EGL_EXT_device_enumeration"));
  const auto queryDevices = devices ? entryPoint<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT") : nullptr;
  const auto deviceString =
      devices ? entryPoint<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT") : nullptr;

  EGLint count = 0;
  if (platformDisplay && queryDevices && deviceString && queryDevices(0, nullptr, &count) && count > 0) {
    std::vector<EGLDeviceEXT> found(static_cast<std::size_t>(count));
    if (!queryDevices(count, found.data(), &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      // Mesa's software device draws as the surfaceless platform below does, which needs fewer privileges.
      if (contains(deviceString(found[i], EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
      list.push_back(
          {"EGL device " + std::to_string(i), platformDisplay(EGL_PLATFORM_DEVICE_EXT, found[i], nullptr)});
    }
  }
  if (platformDisplay && contains(client, "EGL_MESA_platform_surfaceless"))
    list.push_back({"Mesa without a surface",
                    platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  list.push_back({"default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
  return list;
}

constexpr int kLeastVersion = 33;  // major * 10 + minor

struct Version {
  int major, minor;
};

EGLContext createContext(EGLDisplay display, EGLConfig config, const ContextOptions& options,
                         Version version) {
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION_KHR, version.major,
                                    EGL_CONTEXT_MINOR_VERSION_KHR, version.minor};
  EGLint flags = options.debug ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0;
  if (options.api == Api::kGl) {
    flags |= EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE_BIT_KHR;
    attributes.insert(attributes.end(),
                      {EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR});
  }
  attributes.insert(attributes.end(), {EGL_CONTEXT_FLAGS_KHR, flags, EGL_NONE});
  return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
}

// A context on one display, or EGL_NO_CONTEXT and the reason.
EGLContext tryDisplay(EGLDisplay display, const ContextOptions& options, std::string& reason) {
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_create_context", "EGL_KHR_surfaceless_context"})
    if (!contains(extensions, needed)) {
      reason = std::string("lacks ") + needed;
      return EGL_NO_CONTEXT;
    }
  const bool gl = options.api == Api::kGl;
  if (!eglBindAPI(gl ? EGL_OPENGL_API : EGL_OPENGL_ES_API)) {
    reason = gl ? "cannot do OpenGL" : "cannot do OpenGL ES";
    return EGL_NO_CONTEXT;
  }
  // No surface is made, so none of its properties matter; by default EGL would insist on windows.
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE,
                           gl ? EGL_OPENGL_BIT : EGL_OPENGL_ES3_BIT_KHR, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) {
    reason = "has no suitable configuration";
    return EGL_NO_CONTEXT;
  }
  static constexpr Version kGlVersions[] = {{4, 5}, {4, 3}, {3, 3}};
  static constexpr Version kGlesVersions[] = {{3, 2}, {3, 0}};
  EGLContext context = EGL_NO_CONTEXT;
  const auto attempt = [&](const Version& version) {
    if (context == EGL_NO_CONTEXT) context = createContext(display, config, options, version);
  };
  if (gl)
    for (const Version& version : kGlVersions) attempt(version);
  else
    for (const Version& version : kGlesVersions) attempt(version);
  if (context == EGL_NO_CONTEXT) {
    reason = std::string("refuses ") + (gl ? "OpenGL 3.3" : "OpenGL ES 3.0") + " (" + eglErrorName() + ")";
  } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    reason = "cannot make its context current (" + eglErrorName() + ")";
    eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
  }
  return context;
}

void APIENTRY recordMessage(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei,
                            const GLchar* message, const void* user) {
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;  // Program throws with the log
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR &&
      severity != GL_DEBUG_SEVERITY_HIGH)
    return;
  static_cast<std::vector<std::string>*>(const_cast<void*>(user))->emplace_back(message);
}

std::string text(GLenum name) {
  const GLubyte* s = glGetString(name);
  return s ? reinterpret_cast<const char*>(s) : "";
}

}  // namespace

struct Context::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  Api api = Api::kGl;
  int version = 0;  // major * 10 + minor
  std::string device;
  std::vector<std::string> messages;
};

Context::Context(const ContextOptions& options) : impl_(std::make_unique<Impl>()) {
  requireLibraries(options.api);
  impl_->api = options.api;
  std::string failures;
  for (const Candidate& candidate : candidates()) {
    std::string reason;
    if (initialise(candidate.display)) {
      impl_->context = tryDisplay(candidate.display, options, reason);
    } else {
      reason = "cannot be opened (" + eglErrorName() + ")";
    }
    if (impl_->context != EGL_NO_CONTEXT) {
      impl_->display = candidate.display;
      break;
    }
    failures += (failures.empty() ? "" : "; ") + candidate.name + ' ' + reason;
  }
  if (impl_->context == EGL_NO_CONTEXT) throw GpuError("no graphics context: " + failures);

  impl_->version = epoxy_gl_version();
  impl_->device = text(GL_RENDERER);
  const bool desktop = options.api == Api::kGl;
  const bool hasDebug =
      desktop ? impl_->version >= 43 || epoxy_has_gl_extension("GL_KHR_debug") : impl_->version >= 32;
  if (options.debug && hasDebug) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(recordMessage, &impl_->messages);
  }
}

Context::~Context() {
  if (eglGetCurrentContext() == impl_->context)
    eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(impl_->display, impl_->context);
}

void Context::makeCurrent() {
  eglBindAPI(impl_->api == Api::kGl ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
  if (!eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context))
    throw GpuError("the graphics context cannot be made current (" + eglErrorName() + ")");
}

std::string Context::deviceName() const {
  return impl_->device;
}
int Context::majorVersion() const {
  return impl_->version / 10;
}
int Context::minorVersion() const {
  return impl_->version % 10;
}
bool Context::hasCompute() const {
  return impl_->api == Api::kGl && impl_->version >= 43;
}

bool isSoftwareDevice(std::string_view name) {
  for (const char* rasteriser : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (name.find(rasteriser) != std::string_view::npos) return true;
  return false;
}
bool Context::isSoftware() const {
  return isSoftwareDevice(impl_->device);
}

int Context::maxTextureSize2D() const {
  GLint size = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &size);
  return size;
}

int Context::maxTextureSize3D() const {
  GLint size = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &size);
  return size;
}

std::vector<std::string> Context::takeErrors() {
  std::vector<std::string> errors = std::exchange(impl_->messages, {});
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError())
    errors.push_back("glGetError " + std::to_string(error));
  return errors;
}

void requireCurrent() {
  const auto current = [] {
    static const bool egl = opens("libEGL.so.1");
    if (egl && eglGetCurrentContext() != EGL_NO_CONTEXT) return true;
    // Those of GLX are there where the application has loaded it.
    using GetCurrent = void* (*)();
    for (const char* name : {"libGLX.so.0", "libGL.so.1"})
      if (void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL | RTLD_NOLOAD)) {
        const auto get = reinterpret_cast<GetCurrent>(dlsym(library, "glXGetCurrentContext"));
        const bool any = get && get();
        dlclose(library);
        if (any) return true;
      }
    return false;
  };
  if (!current()) throw GpuError("no OpenGL context is current in this thread");
  if (epoxy_is_desktop_gl() && epoxy_gl_version() >= kLeastVersion) return;
  const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  throw GpuError("the current context is " + std::string(version ? version : "lost") +
                 "; expected OpenGL 3.3 or later");
}

struct CurrentGuard::Kept {
  EGLenum api;
  EGLDisplay display;
  EGLContext context;
  EGLSurface draw, read;
};

CurrentGuard::CurrentGuard() {
  if (!opens("libEGL.so.1")) return;  // then nothing is current
  kept_ = std::make_unique<Kept>(Kept{eglQueryAPI(), eglGetCurrentDisplay(), eglGetCurrentContext(),
                                      eglGetCurrentSurface(EGL_DRAW), eglGetCurrentSurface(EGL_READ)});
}

CurrentGuard::~CurrentGuard() {
  if (!kept_) return;
  if (eglGetCurrentContext() != kept_->context) {
    const bool none = kept_->context == EGL_NO_CONTEXT;
    eglMakeCurrent(none ? eglGetCurrentDisplay() : kept_->display, kept_->draw, kept_->read, kept_->context);
  }
  eglBindAPI(kept_->api);
}

}  // namespace welkin::gpu
