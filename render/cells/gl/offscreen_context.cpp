#include "render/cells/gl/offscreen_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/core.h>

#include <vector>

#include "emscape/base/error.h"

namespace emscape::render::gl {
namespace {

/// libepoxy ends the program if a library is missing.
void requireLibrary(const char* name) {
  if (void* const library = dlopen(name, RTLD_LAZY | RTLD_LOCAL)) {
    dlclose(library);
    return;
  }
  throw Error(ErrorCode::device, fmt::format("OpenGL without a window needs the library {}, which is not "
                                             "installed",
                                             name));
}

bool hasExtension(EGLDisplay display, const char* name) {
  return epoxy_has_egl_extension(display, name);
}

/// Displays to try: GPUs first.
std::vector<EGLDisplay> candidates() {
  std::vector<EGLDisplay> displays;
  if (hasExtension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      hasExtension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (eglQueryDevicesEXT(16, devices, &count)) {
      for (int i = 0; i < count; ++i) {
        displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
      }
    }
  }
  if (hasExtension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return displays;
}

}  // namespace

struct OffscreenContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  ~Handles() {
    if (context != EGL_NO_CONTEXT) {
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(display, context);
    }
    // The display is shared by all contexts of the process: not terminated.
  }

  bool open(EGLDisplay candidate) {
    if (candidate == EGL_NO_DISPLAY || !eglInitialize(candidate, nullptr, nullptr)) return false;
    if (!hasExtension(candidate, "EGL_KHR_surfaceless_context") || !eglBindAPI(EGL_OPENGL_API)) return false;
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(candidate, wanted, &config, 1, &count) || count == 0) return false;
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                              3,
                              EGL_CONTEXT_MINOR_VERSION,
                              3,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                              EGL_NONE};
    const EGLContext made = eglCreateContext(candidate, config, EGL_NO_CONTEXT, version);
    if (made == EGL_NO_CONTEXT) return false;
    if (!eglMakeCurrent(candidate, EGL_NO_SURFACE, EGL_NO_SURFACE, made)) {
      eglDestroyContext(candidate, made);
      return false;
    }
    display = candidate;
    context = made;
    return true;
  }
};

OffscreenContext::OffscreenContext() : handles_(std::make_unique<Handles>()) {
  requireLibrary("libEGL.so.1");
  requireLibrary("libGL.so.1");
  for (const EGLDisplay display : candidates()) {
    if (!handles_->open(display)) continue;
    const auto text = [](GLenum of) { return reinterpret_cast<const char*>(glGetString(of)); };
    name_ = fmt::format("{}, {}", text(GL_VENDOR), text(GL_RENDERER));
    return;
  }
  throw Error(ErrorCode::device, "no EGL display gives an OpenGL 3.3 context without a window");
}

OffscreenContext::~OffscreenContext() = default;

void OffscreenContext::makeCurrent() {
  // The current API is one per thread.
  if (!eglBindAPI(EGL_OPENGL_API) ||
      !eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles_->context)) {
    throw Error(ErrorCode::device, "cannot make the OpenGL context current");
  }
}

void OffscreenContext::release() {
  eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace emscape::render::gl
