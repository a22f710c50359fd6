/// Completion of a command line in shells: subcommands, options, choices of options, files.
#pragma once

#include <string>

#include "apps/manual/command_description.h"

namespace emscape::manual {

/// A bash script, to be sourced or installed as bash-completion/completions/PROGRAM.
std::string bashCompletion(const CommandDescription& program);

/// A zsh function, to be installed as _PROGRAM in a folder of $fpath.
std::string zshCompletion(const CommandDescription& program);

}  // namespace emscape::manual
