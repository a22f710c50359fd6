/// Table of the settings of a view: keys of view files, options of `emscape render` and `emscape view`, verbs
/// and menu of the window. Checks, documentation and differences between views are derived from it.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "document/schema.h"
#include "emscape/playback/view/view_state.h"

namespace emscape::playback {

/// A switch, a number, a text or the name of a choice, or a list of texts.
using SettingValue = std::variant<bool, double, std::string, std::vector<std::string>>;

/// What differs between two views.
struct ViewChange {
  bool field = false;  ///< the shown field, without edits of the scenario
  bool split = false;  ///< the part of the picture with the reference
  bool time = false;
  bool size = false;
  bool camera = false;
  bool settings = false;  ///< ViewState::settings
  bool colors = false;
  bool ground = false;
  bool labels = false;
  bool pattern = false;
};

struct ViewSetting {
  std::string key;           ///< in view files; empty: not stored
  document::ValueSpec spec;  ///< type and limits
  std::string meaning;       ///< in the documentation, as are the next two
  std::string default_text;
  std::string value_text;
  bool ViewChange::*affects = nullptr;  ///< null: not the picture

  std::string option, option_help;  ///< of the command line; empty: none

  std::string verb, argument, verb_help;  ///< of the window; empty: none, or one that is not of the table
  std::string action, keys;               ///< of the window's menu View, as in Action; may be empty

  std::function<SettingValue(const ViewState&)> get;
  /// Null if the value cannot be stated as a SettingValue. @throws Error for a text that is not allowed
  std::function<void(ViewState&, const SettingValue&)> set;
  /// As set(), for options and verbs: also changes what depends on the value.
  std::function<void(ViewState&, const SettingValue&)> change;

  bool isSwitch() const { return spec.type == document::ValueType::boolean; }
  bool isNumber() const { return spec.type == document::ValueType::number; }
  bool isChoice() const { return spec.type == document::ValueType::choice; }
  bool isListOfTexts() const;
  bool isSame(const ViewState& a, const ViewState& b) const;
  /// The value as text: that of the option, if it is no list.
  std::string text(const ViewState& view) const;
  /// The option as documented: "--mode dvr|mida|mip|iso".
  std::string optionText() const;
  /// Changes a switch to the other value, a choice to the next one.
  void changeToNext(ViewState& view) const;
};

/// In the order of view files.
const std::vector<ViewSetting>& viewSettings();
/// The setting must exist.
const ViewSetting& settingOfKey(const std::string& key);
/// Null if no setting has it.
const ViewSetting* settingOfVerb(const std::string& verb);

ViewChange changeOf(const ViewState& before, const ViewState& after);

/// Parses "MIN:MAX". @throws Error (usage)
ValueRange parseRange(const std::string& text);

}  // namespace emscape::playback
