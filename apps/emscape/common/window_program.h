/// Starts emscape-view, the program with the window.
#pragma once

#include <string>
#include <vector>

#include "apps/emscape/common/command.h"

namespace emscape::app {

/// The command line of emscape-view: the program in the folder of this one, with the global options. @param
/// arguments appended
std::vector<std::string> windowCommand(const GlobalOptions& global,
                                       const std::vector<std::string>& arguments);

/// Replaces this process by emscape-view. @throws Error (device) if it is not installed
[[noreturn]] void becomeWindow(const GlobalOptions& global, const std::vector<std::string>& arguments);

/// Runs emscape-view and waits for its end; its messages go to standard error. @throws Error with its exit
/// status; (device) if it is not installed
void runWindow(const GlobalOptions& global, const std::vector<std::string>& arguments);

}  // namespace emscape::app
