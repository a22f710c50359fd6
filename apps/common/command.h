/// Global options, and options that several subcommands have.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/common/command_line.h"
#include "emscape/base/error.h"
#include "emscape/playback/view/view_state.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/scenario/model/edit.h"

namespace emscape::app {

/// Options that every subcommand takes, before or after its name.
struct GlobalOptions {
  std::string backend = "auto";
  int threads = 0;  ///< 0: one per core
  int devices = 1;  ///< 0: all
  bool json = false;
  bool quiet = false;
};

/// A number of GPUs as the option takes it.
inline std::string devicesText(int devices) {
  return devices == 0 ? "all" : std::to_string(devices);
}

/// Adds the option of the number of GPUs.
inline CLI::Option* addDevicesOption(CLI::App& app, int& devices) {
  return app
      .add_option_function<std::string>(
          "--devices", [&devices](const std::string& text) { devices = text == "all" ? 0 : std::stoi(text); },
          "GPUs that share out the emitters of a field: a number or all")
      ->check(CLI::IsMember({"all"}) | CLI::Range(1, 64))
      ->default_str("1");
}

/// Adds an option with several values, separated by commas, since a word after a blank may be the
/// subcommand's input.
inline CLI::Option* addListOption(CLI::App& command, const std::string& name,
                                  std::vector<std::string>& values, const std::string& description) {
  return command.add_option(name, values, description)->delimiter(',')->allow_extra_args(false);
}

/// Adds an option with names of a scenario's items: separated by commas, and it may be given several times,
/// for names that contain a comma; see namedIndices().
inline CLI::Option* addNamesOption(CLI::App& command, const std::string& name,
                                   std::vector<std::string>& values, const std::string& description) {
  return command.add_option(name, values, description)->allow_extra_args(false);
}

/// The check of an option that is a setting of pictures.
inline CLI::Range within(const render::SettingLimits& limits) {
  return {limits.min, limits.max};
}

/// The option that a hint suggests, as " (...)"; empty for Hint::none, and for a subcommand without the
/// option.
/// @param app  the program or its subcommand
std::string optionText(const CLI::App& app, Hint hint);

/// Adds --set PATH=VALUE, which may be given several times. Parsing it throws Error (usage) for a text
/// without '='.
void addSetOption(CLI::App& command, std::vector<scenario::Edit>& edits, const std::string& name = "--set",
                  const std::string& what = "changes a value of the scenario");

/// Adds --compare original|FILE. @param what  result of the command, for the help
void addCompareOption(CLI::App& command, std::string& compare, const std::string& what);
/// Adds --mesh, --cells, --cell-rasterizer, --cell-order and --cell-perspective, for pictures.
/// Parsing them throws Error (usage).
void addMeshOptions(CLI::App& command, std::string& mesh, playback::CellStyle& cells);

}  // namespace emscape::app
