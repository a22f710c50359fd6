/// A program's command line: the parser with the global options, and running it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace emscape::app {

struct GlobalOptions;
/// Runs the subcommand that was chosen; returns the exit status.
using Action = std::function<int()>;
/// Adds a program's subcommands to the parser; each sets `action` when the parser meets it.
using AddSubcommands = std::function<void(CLI::App& app, const GlobalOptions& global, Action& action)>;

/// The parser of `emscape` with the global options and some subcommands.
class CommandLine {
 public:
  explicit CommandLine(const AddSubcommands& addSubcommands);
  ~CommandLine();

  const CLI::App& parser() const;
  /// Parses a command line without running it. Memory grows with the number of calls, as the parser keeps
  /// parts of earlier ones; to make a parser takes eight times as long as to parse.
  /// @param arguments  the subcommand and its options, without the program's name
  /// @throws Error (usage) for arguments that cannot be parsed or that request help or version
  void parse(const std::vector<std::string>& arguments);

 private:
  friend int runCommandLine(const std::vector<std::string>&, const AddSubcommands&);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Runs a command line as a program: prints the result and messages, catches signals, sets the process's
/// limit of threads and its log.
/// @param words  arguments without the program's name
/// @return the exit status
int runCommandLine(const std::vector<std::string>& words, const AddSubcommands& addSubcommands);

/// The main function of a program with these subcommands: runs its command line; a failure ends the process.
/// @param words  arguments without the program's name
/// @return the exit status 0
int runProgram(const std::vector<std::string>& words, const AddSubcommands& addSubcommands);

}  // namespace emscape::app
