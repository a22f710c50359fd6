/// An OpenGL context without a window.
#pragma once

#include <memory>
#include <string>

namespace emscape::render::gl {

/// OpenGL 3.3 core by EGL: on a GPU's own device where there is one, else Mesa's software. One thread at a
/// time has it current.
class OffscreenContext {
 public:
  /// Makes it current.
  /// @throws Error (device) that says what is missing: libEGL, a display, or OpenGL 3.3
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  void makeCurrent();
  /// Another thread may make it current then.
  void release();
  /// "VENDOR, RENDERER" as OpenGL names them.
  const std::string& name() const { return name_; }

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  std::string name_;
};

}  // namespace emscape::render::gl
