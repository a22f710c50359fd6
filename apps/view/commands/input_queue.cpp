#include "apps/view/commands/input_queue.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

struct NamedKey {
  const char* name;
  int code;
};
/// If two rows have the same name, scripts press the first one.
constexpr NamedKey kKeys[] = {
    {"Space", GLFW_KEY_SPACE},     {"Right", GLFW_KEY_RIGHT}, {"Left", GLFW_KEY_LEFT},
    {"Up", GLFW_KEY_UP},           {"Down", GLFW_KEY_DOWN},   {"Home", GLFW_KEY_HOME},
    {"End", GLFW_KEY_END},         {"Tab", GLFW_KEY_TAB},     {"Esc", GLFW_KEY_ESCAPE},
    {"Enter", GLFW_KEY_ENTER},     {"F1", GLFW_KEY_F1},       {"F5", GLFW_KEY_F5},
    {"F10", GLFW_KEY_F10},         {"F12", GLFW_KEY_F12},     {"+", GLFW_KEY_EQUAL},
    {"+", GLFW_KEY_KP_ADD},        {"-", GLFW_KEY_MINUS},     {"-", GLFW_KEY_KP_SUBTRACT},
    {".", GLFW_KEY_PERIOD},        {",", GLFW_KEY_COMMA},     {"[", GLFW_KEY_LEFT_BRACKET},
    {"]", GLFW_KEY_RIGHT_BRACKET}, {"?", GLFW_KEY_SLASH},     {"Backspace", GLFW_KEY_BACKSPACE},
    {"Delete", GLFW_KEY_DELETE}};

bool isCharacter(int code, char first, char last) {
  return code >= first && code <= last;
}

bool leavesField(int code) {
  return code == GLFW_KEY_ENTER || code == GLFW_KEY_KP_ENTER || code == GLFW_KEY_TAB ||
         code == GLFW_KEY_ESCAPE;
}

/// The press of a key whose character comes as an event of its own: a field needs the character alone.
bool isTypedCharacter(const InputEvent& event) {
  constexpr int kShortcuts = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
  return event.kind == InputEvent::Kind::key && event.action != GLFW_RELEASE &&
         (event.modifiers & kShortcuts) == 0 && event.code >= GLFW_KEY_SPACE && event.code < GLFW_KEY_ESCAPE;
}

/// Shift, Control, Alt or Super of either side.
bool isModifier(int code) {
  return code >= GLFW_KEY_LEFT_SHIFT && code <= GLFW_KEY_RIGHT_SUPER;
}

}  // namespace

void InputQueue::push(InputEvent event) {
  if (event.kind == InputEvent::Kind::key && isModifier(event.code)) {
    const int key = event.code - GLFW_KEY_LEFT_SHIFT, modifier = key % kModifiers;
    held_[static_cast<std::size_t>(key)] = event.action != GLFW_RELEASE;
    const bool is_held =
        held_[static_cast<std::size_t>(modifier)] || held_[static_cast<std::size_t>(modifier + kModifiers)];
    event.modifiers = (event.modifiers & ~(1 << modifier)) | (is_held ? 1 << modifier : 0);
  }
  events_.push_back(event);
}

std::vector<InputEvent> InputQueue::takeFrame(bool is_typing) {
  using Kind = InputEvent::Kind;
  std::vector<InputEvent> frame;
  std::set<std::pair<Kind, int>> changed;
  std::optional<int> modifiers;
  bool has_cursor = false, has_button = false, has_press = false, has_text = false, moves_focus = false;
  frames_to_focus_ = std::max(0, frames_to_focus_ - 1);
  while (!events_.empty()) {
    const InputEvent& event = events_.front();
    if (is_typing && isTypedCharacter(event) && !has_press && frames_to_focus_ == 0) {
      events_.pop_front();
      continue;
    }
    const bool is_press = event.kind == Kind::key && event.action == GLFW_PRESS && !isModifier(event.code);
    // A field that Enter or Tab leaves has its text from an earlier frame.
    if (is_press && (has_press || has_button || has_text || frames_to_focus_ > 0)) break;
    has_press = has_press || is_press;
    has_text = has_text || event.kind == Kind::text;
    has_cursor = has_cursor || event.kind == Kind::cursor;
    has_button = has_button || event.kind == Kind::button;
    if (has_cursor && has_button) break;
    if (event.kind == Kind::key || event.kind == Kind::button) {
      if (event.modifiers != modifiers.value_or(event.modifiers)) break;
      modifiers = event.modifiers;
      const bool is_of_character = is_typing && event.kind == Kind::key && event.code < GLFW_KEY_ESCAPE;
      if (event.action != GLFW_REPEAT && !is_of_character && !changed.insert({event.kind, event.code}).second)
        break;
    }
    moves_focus = moves_focus || (is_press && (!is_typing || leavesField(event.code))) ||
                  (event.kind == Kind::button && event.action == GLFW_RELEASE);
    frame.push_back(event);
    events_.pop_front();
  }
  if (moves_focus) frames_to_focus_ = kFramesToFocus;
  return frame;
}

KeyChord chordOf(const InputEvent& event) {
  KeyChord chord;
  chord.control = (event.modifiers & GLFW_MOD_CONTROL) != 0;
  chord.shift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
  if (isCharacter(event.code, 'A', 'Z') || isCharacter(event.code, '0', '9')) {
    chord.key = std::string(1, static_cast<char>(event.code));
  }
  for (const NamedKey& key : kKeys) {
    if (key.code == event.code) chord.key = key.name;
  }
  // These need Shift on some keyboards and not on others.
  if (chord.key == "+" || chord.key == "?") chord.shift = false;
  return chord;
}

std::array<InputEvent, 2> eventsOf(const KeyChord& chord) {
  int code = GLFW_KEY_UNKNOWN;
  if (chord.key.size() == 1 && (isCharacter(chord.key[0], 'A', 'Z') || isCharacter(chord.key[0], '0', '9'))) {
    code = chord.key[0];
  }
  for (const NamedKey& key : kKeys) {
    if (code == GLFW_KEY_UNKNOWN && chord.key == key.name) code = key.code;
  }
  if (code == GLFW_KEY_UNKNOWN) throw Error(ErrorCode::bad_input, fmt::format("unknown key '{}'", chord.key));
  const int modifiers = (chord.control ? GLFW_MOD_CONTROL : 0) | (chord.shift ? GLFW_MOD_SHIFT : 0);
  return {InputEvent{InputEvent::Kind::key, code, 0, GLFW_PRESS, modifiers, 0, 0},
          InputEvent{InputEvent::Kind::key, code, 0, GLFW_RELEASE, 0, 0, 0}};
}

const std::vector<MouseButton>& mouseButtons() {
  static const std::vector<MouseButton> all{{"left", GLFW_MOUSE_BUTTON_LEFT},
                                            {"middle", GLFW_MOUSE_BUTTON_MIDDLE},
                                            {"right", GLFW_MOUSE_BUTTON_RIGHT}};
  return all;
}

}  // namespace emscape::view
