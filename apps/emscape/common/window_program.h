/// Start of emscape-view, the program of the window.
#pragma once

#include <string>
#include <vector>

#include "apps/emscape/common/command.h"

namespace emscape::app {

/// Its command line: the program in the folder of this one, with the global options. @param arguments
/// appended
std::vector<std::string> windowCommand(const GlobalOptions& global,
                                       const std::vector<std::string>& arguments);

/// Replaces this process by it. @throws Error (device) if it is not installed
[[noreturn]] void becomeWindow(const GlobalOptions& global, const std::vector<std::string>& arguments);

/// Runs it and waits for its end; its messages go to standard error. @throws Error with its exit status,
/// (device) if it is not installed
void runWindow(const GlobalOptions& global, const std::vector<std::string>& arguments);

}  // namespace emscape::app
