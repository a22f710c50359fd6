/// Options of the command line that change a view.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "playback/view/view_settings.h"

namespace emscape::app {

/// The options of the table of settings. They have an effect only if they are given.
class ViewArguments {
 public:
  /// Adds the options to a command, which refers to this object. @param but  names of options to leave out
  void addTo(CLI::App& command, const std::vector<std::string>& but);
  /// The same of some settings, by their keys.
  void addSomeTo(CLI::App& command, const std::vector<std::string>& keys);
  /// Changes a view by the options that were given. @throws Error (usage) for a value that is not allowed
  void apply(playback::ViewState& view) const;

 private:
  void add(CLI::App& command, const playback::ViewSetting& setting);

  std::vector<std::pair<const playback::ViewSetting*, playback::SettingValue>> given_;
};

}  // namespace emscape::app
