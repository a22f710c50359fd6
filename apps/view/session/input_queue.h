/// Keyboard and mouse events in order, distributed to frames.
#pragma once

#include <array>
#include <deque>
#include <set>
#include <vector>

#include "apps/view/session/window_control.h"

namespace emscape::view {

/// A GUI that reads the state of keys once per frame misses a key that is pressed and released within one,
/// and does not know where the cursor was when a button changed. Therefore a frame takes events only until a
/// key or button would change for the second time, and contains either movements of the cursor or changes of
/// buttons; the others wait for the next frame.
class InputQueue {
 public:
  void push(const InputEvent& event) { events_.push_back(event); }
  bool empty() const { return events_.empty(); }
  /// The events of the next frame.
  std::vector<InputEvent> takeFrame();

 private:
  std::deque<InputEvent> events_;
};

/// The chord of a key event, in the form used by the table of actions; an empty key if it has none.
KeyChord chordOf(const InputEvent& event);
/// Press and release of a chord. @throws Error (bad_input) for an unknown key
std::array<InputEvent, 2> eventsOf(const KeyChord& chord);

/// A mouse button by its name in scripts.
struct MouseButton {
  const char* name;
  int code;  ///< GLFW_MOUSE_BUTTON_*
};
const std::vector<MouseButton>& mouseButtons();

}  // namespace emscape::view
