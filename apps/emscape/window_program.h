/// emscape-view, the program of the window, as this program starts it.
#pragma once

#include <string>
#include <vector>

#include "apps/emscape/command.h"

namespace emscape::app {

/// Its command line: beside this program, with the global options. @param arguments  what follows
std::vector<std::string> windowCommand(const GlobalOptions& global,
                                       const std::vector<std::string>& arguments);

/// Becomes it. @throws Error (device) if it is not there
[[noreturn]] void becomeWindow(const GlobalOptions& global, const std::vector<std::string>& arguments);

/// Runs it to its end; its messages go to standard error.
/// @throws Error with the code that it ended with, (device) if it is not there
void runWindow(const GlobalOptions& global, const std::vector<std::string>& arguments);

}  // namespace emscape::app
