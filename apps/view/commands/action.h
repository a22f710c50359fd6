/// The actions of menus and keys: one table, from which the menus, the key handling, the help panel and
/// docs/viewer.md are generated.
#pragma once

#include <string>
#include <vector>

#include "apps/view/commands/command.h"

namespace emscape::view {

struct Action {
  const char* menu;  ///< File, Edit, Time, Camera, View or Panels
  const char* name;
  const char* keys;          ///< chords separated by blanks: "Right .", "Ctrl+Shift+Z"
  std::string command;       ///< the same as a script line
  std::string command_line;  ///< the same on the command line
  const char* section = "";  ///< in View the submenu, elsewhere separators divide the sections
};

/// Whether a key that is held performs the action again: steps and turns, but no switches.
bool repeats(const Action& action);

const std::vector<Action>& actions();
std::vector<std::string> menuNames();

/// A key with its modifiers. `key` is a name from the table: "Space", "F12", "A", "1", "+".
struct KeyChord {
  std::string key;
  bool control = false, shift = false;
};
/// Reads "Ctrl+Shift+Z". @throws Error (bad_input)
KeyChord parseChord(const std::string& text);
std::string toString(const KeyChord& chord);
bool operator==(const KeyChord& a, const KeyChord& b);
std::vector<KeyChord> chordsOf(const Action& action);

/// The action of a key; null if it has none.
const Action* actionOf(const KeyChord& chord);

/// The tables of keys, of mouse gestures and of script verbs, as Markdown.
std::string manualTables();

/// The mouse gestures, for help and manual.
struct Gesture {
  const char* gesture;
  const char* does;
};
const std::vector<Gesture>& gestures();

}  // namespace emscape::view
