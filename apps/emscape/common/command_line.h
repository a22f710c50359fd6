/// The command line as functions: for the program, and for the Python package.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/base/progress.h"

namespace CLI {
class App;
}

namespace emscape::app {

/// Runs a command line as a program: prints the result and messages, catches signals, sets the process's
/// limit of threads and its log.
/// @param argv  the program's name and its arguments, ended by a null pointer
/// @return the exit status
int runCommandLine(int argc, char** argv);

/// The parser of the command line, for generating its documentation.
std::shared_ptr<const CLI::App> commandLineParser();

/// Parses command lines without running them. To make one takes eight times as long as to parse.
class CommandLineCheck {
 public:
  CommandLineCheck();
  ~CommandLineCheck();
  /// Memory grows with the number of calls, as the parser keeps parts of earlier ones.
  /// @param arguments  the subcommand and its options, without the program's name
  /// @throws Error (usage) for arguments that cannot be parsed or that request help or version
  void parse(const std::vector<std::string>& arguments);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Result of a subcommand.
struct CommandResult {
  int status = 0;    ///< exit status: 0, or that of a failed check
  std::string json;  ///< output of the program with --json
};

/// Runs one subcommand with --json within a program. Prints nothing, leaves signals and the log as they are,
/// and removes the limit of threads that a subcommand has set.
/// @param arguments  the subcommand and its options, without the program's name
/// @param progress   may be empty; an exception that it throws ends the work and reaches the caller
/// @throws Error with the code that the program exits with: (usage) for arguments that cannot be parsed and
/// for view, which replaces the process; otherwise as thrown by the subcommand's functions
CommandResult commandResult(const std::vector<std::string>& arguments, const ProgressSink& progress);

/// Sets the command that starts this program as another process, for `study --jobs`; the default is the
/// executable of the running process. For hosts whose process is not emscape. @param words  program and first
/// arguments
void setProgramCommand(const std::vector<std::string>& words);
const std::vector<std::string>& programCommand();

}  // namespace emscape::app
