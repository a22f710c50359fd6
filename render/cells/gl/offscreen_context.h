/// An OpenGL context without a window.
#pragma once

#include <memory>
#include <string>

namespace emscape::render::gl {

/// OpenGL 3.3 core through EGL: on a GPU if there is one, else Mesa's software. Current in one thread at a
/// time.
class OffscreenContext {
 public:
  /// Makes it current.
  /// @throws Error (device) that says what is missing: libEGL, a display, or OpenGL 3.3
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  void makeCurrent();
  /// Releases it, so that another thread may make it current.
  void release();
  /// "VENDOR, RENDERER" as OpenGL names them.
  const std::string& name() const { return name_; }

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  std::string name_;
};

}  // namespace emscape::render::gl
