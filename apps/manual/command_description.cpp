#include "apps/manual/command_description.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace emscape::manual {
namespace {

/// Splits CLI11's text of a type and its validators: "TEXT:{a,b}" or "INT:INT in [0 - 9]".
void describeType(const std::string& type, OptionDescription& option) {
  const std::size_t colon = type.find(':');
  option.value = type.substr(0, colon);
  if (colon == std::string::npos) return;
  option.allowed = type.substr(colon + 1);
  if (option.allowed.size() < 2 || option.allowed.front() != '{' || option.allowed.back() != '}') return;
  std::istringstream names(option.allowed.substr(1, option.allowed.size() - 2));
  for (std::string name; std::getline(names, name, ',');) option.choices.push_back(name);
  option.allowed.clear();
}

OptionDescription describe(const CLI::Option& option) {
  OptionDescription result;
  if (option.get_positional()) {
    result.names = {option.get_single_name()};
  } else {
    for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  }
  if (option.get_type_size() != 0) {
    describeType(option.get_type_name(), result);
    result.default_value = option.get_default_str();
    if (result.default_value == "[]") result.default_value.clear();  // a list
    result.repeats = option.get_expected_max() > 1;
  }
  result.help = option.get_description();
  result.required = option.get_required();
  return result;
}

}  // namespace

CommandDescription describe(const CLI::App& command) {
  CommandDescription result;
  result.name = command.get_name();
  result.summary = command.get_description();
  result.footer = command.get_footer();
  for (const CLI::Option* option : command.get_options({})) {
    if (option->get_group().empty()) continue;
    (option->get_positional() ? result.positionals : result.options).push_back(describe(*option));
  }
  for (const CLI::App* subcommand : command.get_subcommands({})) {
    result.subcommands.push_back(describe(*subcommand));
  }
  return result;
}

}  // namespace emscape::manual
