/// Operations of the window used by commands.
#pragma once

#include <string>

#include "apps/view/commands/action.h"

namespace emscape::view {

/// A keyboard or mouse event, in the window's pixels.
struct InputEvent {
  enum class Kind { key, text, button, cursor, wheel, left_window };
  Kind kind = Kind::cursor;
  int code = 0;         ///< GLFW's key or button; text: the Unicode code point
  int scancode = 0;     ///< key
  int action = 0;       ///< key, button: GLFW_PRESS, GLFW_RELEASE or GLFW_REPEAT
  int modifiers = 0;    ///< key, button: GLFW_MOD_...
  double x = 0, y = 0;  ///< cursor: position; wheel: offsets
};

/// Limits of the scale of texts and controls.
inline constexpr double kMinScale = 0.5, kMaxScale = 4;

class WindowControl {
 public:
  virtual ~WindowControl() = default;
  virtual void resize(int width, int height) = 0;
  /// Scale of text and controls.
  virtual double scale() const = 0;
  /// @param factor  limited to kMinScale..kMaxScale
  virtual void setScale(double factor) = 0;
  /// Writes the next frame.
  virtual void screenshot(const std::string& file) = 0;
  virtual void setClipboard(const std::string& text) = 0;
  virtual void quit() = 0;
  /// Injects an event as if it came from the user.
  virtual void press(const KeyChord& chord) = 0;
  virtual void inject(const InputEvent& event) = 0;
};

}  // namespace emscape::view
