/// Starts the other programs of Emscape, which lie in the folder of this one.
#pragma once

#include <string>
#include <vector>

#include "apps/common/command.h"

namespace emscape::app {

struct SiblingProgram {
  const char* name;
  const char* absence;  ///< why it may not be there
  ErrorCode code;       ///< of the error if it is not
  bool has_json;        ///< takes --json
};
extern const SiblingProgram kViewProgram, kBenchProgram;

/// Replaces this process by a program, with the global options. @param arguments  appended
/// @throws Error with the program's code if it is not installed
[[noreturn]] void becomeProgram(const SiblingProgram& program, const GlobalOptions& global,
                                const std::vector<std::string>& arguments);

/// Runs a program and waits for its end; its messages go to standard error.
/// @throws Error with its exit status; with the program's code if it is not installed
void runSibling(const SiblingProgram& program, const GlobalOptions& global,
                const std::vector<std::string>& arguments);

}  // namespace emscape::app
