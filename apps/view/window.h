/// The window: GLFW, its OpenGL context and Dear ImGui on it.
#pragma once

#include <string>
#include <vector>

#include "apps/view/commands/input_queue.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/picture/image.h"

struct GLFWwindow;

namespace emscape::view {

/// At most one object exists at a time. For use by the thread that constructs it, except for wake().
class Window {
 public:
  /// @param scale  of text and controls; 0: the screen's scale
  /// @throws Error (device) with the reason
  /// @param scales  true: the size is that at scale 1
  Window(const std::string& title, render::ImageSize size, bool scales, double scale);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Makes waitEvents() return. May be called from any thread, also before and after the window's lifetime.
  static void wake();
  /// Waits for an event. @param timeout_s  maximum wait; 0: does not wait; < 0: unlimited
  void waitEvents(double timeout_s);
  /// True if the user or the display requested a new frame since the last call.
  bool takeDirty();
  void markDirty() { dirty_ = true; }
  /// True if the user has asked to close the window since the last call.
  bool takeCloseRequest();
  /// Files dropped on the window since the last call.
  std::vector<std::string> takeDropped();

  /// 0x0 while it is minimised.
  render::ImageSize framebufferSize() const;
  void resize(int width, int height);
  void setTitle(const std::string& title);
  void setClipboard(const std::string& text);

  double scale() const { return scale_; }
  /// Clamped to 0.5..4; takes effect with the next frame.
  void setScale(double scale);
  void setTheme(render::Theme theme);

  InputQueue& input() { return input_; }
  void drop(std::vector<std::string> files) { dropped_ = std::move(files); }
  /// Begins a frame of Dear ImGui with the events that are due; returns them.
  std::vector<InputEvent> beginFrame();
  /// Draws the commands of Dear ImGui.
  void endFrame();
  /// Ends a frame that is not drawn.
  void dropFrame();
  void swap();
  /// The pixels drawn since the last swap().
  render::Image8 readPixels() const;
  /// Name of the OpenGL renderer.
  std::string renderer() const;

  bool buttonDown(int button) const { return buttons_[button]; }
  bool keyDown(int key) const;

 private:
  void applyStyle();
  void forward(const InputEvent& event);

  GLFWwindow* window_ = nullptr;
  InputQueue input_;
  double cursor_x_ = -1e9, cursor_y_ = -1e9;
  bool buttons_[8]{};
  bool keys_[512]{};
  double scale_ = 1;
  render::Theme theme_ = render::Theme::dark;
  std::vector<std::string> dropped_;
  bool style_changed_ = true;
  bool dirty_ = true;
};

}  // namespace emscape::view
