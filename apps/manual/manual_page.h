/// Manual pages of a command line, in man(7) macros.
#pragma once

#include <string>
#include <vector>

#include "apps/manual/command_description.h"

namespace emscape::manual {

struct ManualPage {
  std::string file;  ///< name, such as "emscape-simulate.1"
  std::string text;
};

/// One page for the program and one for each subcommand; a subcommand's own subcommands are on its page.
/// @param version  of the program
std::vector<ManualPage> manualPages(const CommandDescription& program, const std::string& version);

}  // namespace emscape::manual
