#include "apps/common/sibling_program.h"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "apps/common/interrupt.h"

namespace emscape::app {
namespace {

constexpr int kNotStarted = 127;

std::vector<char*> argumentsOf(std::vector<std::string>& words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return argv;
}

Error notStarted(const SiblingProgram& program, const std::string& file, int cause) {
  return Error(program.code, cause == ENOENT ? file + " is not there: " + program.absence
                                             : file + ": " + std::strerror(cause));
}

/// The program in the folder of this one, with the global options and the arguments.
std::vector<std::string> commandOf(const SiblingProgram& program, const GlobalOptions& global,
                                   const std::vector<std::string>& arguments) {
  std::error_code failed;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) {
    throw Error(program.code,
                std::string(program.name) +
                    " cannot be found beside this program: /proc/self/exe: " + failed.message());
  }
  std::vector<std::string> words{(here.parent_path() / program.name).string()};
  if (global.backend != "auto") words.insert(words.end(), {"--backend", global.backend});
  if (global.devices != 1) words.insert(words.end(), {"--devices", devicesText(global.devices)});
  if (global.threads != 0) words.insert(words.end(), {"--threads", std::to_string(global.threads)});
  if (global.json && program.has_json) words.emplace_back("--json");
  if (global.quiet) words.emplace_back("--quiet");
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

}  // namespace

const SiblingProgram kViewProgram{
    "emscape-view",
    "build its target, emscape_view, which needs GLFW, Dear ImGui and libepoxy; 'emscape render' draws "
    "pictures and videos without a window",
    ErrorCode::device, false};
const SiblingProgram kBenchProgram{"emscape-bench", "build its target, emscape_bench", ErrorCode::other,
                                   true};

void becomeProgram(const SiblingProgram& program, const GlobalOptions& global,
                   const std::vector<std::string>& arguments) {
  std::vector<std::string> words = commandOf(program, global, arguments);
  execv(words.front().c_str(), argumentsOf(words).data());
  throw notStarted(program, words.front(), errno);
}

void runSibling(const SiblingProgram& program, const GlobalOptions& global,
                const std::vector<std::string>& arguments) {
  std::vector<std::string> words = commandOf(program, global, arguments);
  const std::vector<char*> argv = argumentsOf(words);
  if (access(words.front().c_str(), X_OK) != 0) throw notStarted(program, words.front(), errno);
  const pid_t process = fork();
  if (process < 0) throw Error(ErrorCode::other, fmt::format("fork: {}", std::strerror(errno)));
  if (process == 0) {
    execv(argv.front(), argv.data());
    _exit(kNotStarted);
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    if (stopFlag()) kill(process, SIGTERM);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFSIGNALED(status)) {
    throw Error(ErrorCode::other,
                fmt::format("{} was ended by signal {}", program.name, strsignal(WTERMSIG(status))));
  }
  throw Error(static_cast<ErrorCode>(WEXITSTATUS(status)),
              fmt::format("{} ended with status {}", program.name, WEXITSTATUS(status)));
}

}  // namespace emscape::app
