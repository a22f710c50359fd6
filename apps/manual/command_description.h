/// A command line as data, read from its parser: what manual pages and shell completion are made of.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace emscape::manual {

struct OptionDescription {
  std::vector<std::string> names;  ///< short ones first: "-o", "--output"; of a positional one: "SCENARIO"
  std::string value;               ///< type of its value, such as TEXT or INT; empty for a flag
  std::string allowed;             ///< limits of the value, such as "INT in [0 - 4096]"; may be empty
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

/// Options of hidden groups are left out, as --help leaves them out.
CommandDescription describe(const CLI::App& command);

}  // namespace emscape::manual
