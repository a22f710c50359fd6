/// Runs the built program as a user would.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::test {

struct ProgramResult {
  int status = 0;   ///< exit status; 128 + N if signal N ended it
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

using Arguments = std::vector<std::string>;

/// A program that runs in the background. Its output goes to its own files.
class RunningProgram {
 public:
  /// @param shell_prefix  shell commands that precede it, such as limits; may be empty
  explicit RunningProgram(const Arguments& arguments, const std::string& shell_prefix = "");
  void signal(int number) const;
  /// Waits for the first line of its standard output, for a minute at most.
  void waitForALine() const;
  ProgramResult wait();

 private:
  TemporaryFolder output_;
  pid_t process_ = -1;
};

/// Path of a file that was built next to this test program.
std::string besideThisProgram(const std::string& name);

/// Runs `emscape ARGUMENTS` to its end.
ProgramResult run(const Arguments& arguments, const std::string& shell_prefix = "");

/// The same; the test fails if the exit status is not 0.
ProgramResult runWell(const Arguments& arguments, const std::string& shell_prefix = "");

/// The standard error of a run that must end with this exit status.
std::string errorOfRun(const Arguments& arguments, int status, const std::string& shell_prefix = "");

/// The arguments, and more after them.
Arguments joined(Arguments arguments, const Arguments& more);

/// scenarios/quick.yaml, the smallest scenario.
const std::string& quick();
/// The same with more voxels and one step per second, written into a folder; slow enough to be interrupted.
std::string longScenario(const TemporaryFolder& folder, int duration_s);

}  // namespace emscape::test
