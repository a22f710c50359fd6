/// Description of a command line, read from its parser; manual pages and shell completion are generated from
/// it.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace emscape::manual {

struct OptionDescription {
  std::vector<std::string>
      names;            ///< short ones first: "-o", "--output"; for a positional argument: "SCENARIO"
  std::string value;    ///< type of its value, such as TEXT or INT; empty for a flag
  std::string allowed;  ///< limits of the value, such as "INT in [0 - 4096]"; may be empty
  std::vector<std::string> choices;
  std::string default_value;  ///< may be empty
  std::string help;
  bool required = false;
  bool repeats = false;
};

struct CommandDescription {
  std::string name;
  std::string summary;
  std::string footer;
  std::vector<OptionDescription> options, positionals;
  std::vector<CommandDescription> subcommands;
};

/// Options of hidden groups are omitted, as in --help.
CommandDescription describe(const CLI::App& command);

}  // namespace emscape::manual
