/// Keyboard and mouse events in order, distributed to frames.
#pragma once

#include <array>
#include <deque>
#include <set>
#include <vector>

#include "apps/view/commands/window_control.h"

namespace emscape::view {

/// Frames from a command to the first one in which a field of the dialog that it opens takes characters.
inline constexpr int kFramesToFocus = 4;

/// A GUI that reads the state of keys once per frame misses a key that is pressed and released within one,
/// and does not know where the cursor was, or which modifiers were held, when a button changed. Therefore a
/// frame takes events only until a key or button would change for the second time, or the modifiers would
/// change; and it contains either movements of the cursor or changes of buttons. A key or a click may open
/// the field that takes the next key: a frame contains one press of a key, not after a button, and after one
/// that may move the focus the next press waits until the field has it. The other events wait for the next
/// frame.
class InputQueue {
 public:
  /// Appends an event. The modifiers of a modifier key become those after the event: GLFW 3.3 reports those
  /// before it on X11 and Wayland.
  void push(InputEvent event);
  bool empty() const { return events_.empty(); }
  /// The events of the next frame. @param is_typing  a text field has the focus
  std::vector<InputEvent> takeFrame(bool is_typing);

 private:
  static constexpr int kModifiers =
      4;  // Shift, Control, Alt, Super: the order of GLFW's keys and of its bits

  std::deque<InputEvent> events_;
  std::array<bool, 2 * kModifiers> held_{};  // the keys of the left side, then those of the right side
  int frames_to_focus_ = 0;                  // in which no key is pressed
};

/// The chord of a key event, in the form used by the table of actions; an empty key if it has none.
KeyChord chordOf(const InputEvent& event);
/// Press with the modifiers, and release without them. @throws Error (bad_input) for an unknown key
std::array<InputEvent, 2> eventsOf(const KeyChord& chord);

/// A mouse button by its name in scripts.
struct MouseButton {
  const char* name;
  int code;  ///< GLFW_MOUSE_BUTTON_*
};
const std::vector<MouseButton>& mouseButtons();

}  // namespace emscape::view
