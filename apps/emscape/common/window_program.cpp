#include "apps/emscape/common/window_program.h"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "apps/emscape/common/interrupt.h"

namespace emscape::app {
namespace {

constexpr int kNotStarted = 127;

std::vector<char*> argumentsOf(std::vector<std::string>& words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return argv;
}

Error notStarted(const std::string& program, int cause) {
  return Error(ErrorCode::device,
               cause == ENOENT
                   ? program +
                         " is not there: build its target, emscape_view, which needs GLFW, Dear ImGui and "
                         "libepoxy; 'emscape render' draws pictures and videos without a window"
                   : program + ": " + std::strerror(cause));
}

}  // namespace

std::vector<std::string> windowCommand(const GlobalOptions& global,
                                       const std::vector<std::string>& arguments) {
  std::error_code failed;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) {
    throw Error(ErrorCode::device,
                "emscape-view cannot be found beside this program: /proc/self/exe: " + failed.message());
  }
  std::vector<std::string> words{(here.parent_path() / "emscape-view").string()};
  if (global.backend != "auto") words.insert(words.end(), {"--backend", global.backend});
  if (global.threads != 0) words.insert(words.end(), {"--threads", std::to_string(global.threads)});
  if (global.quiet) words.emplace_back("--quiet");
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

void becomeWindow(const GlobalOptions& global, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = windowCommand(global, arguments);
  execv(words.front().c_str(), argumentsOf(words).data());
  throw notStarted(words.front(), errno);
}

void runWindow(const GlobalOptions& global, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = windowCommand(global, arguments);
  const std::vector<char*> argv = argumentsOf(words);
  if (access(words.front().c_str(), X_OK) != 0) throw notStarted(words.front(), errno);
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
                fmt::format("emscape-view was ended by signal {}", strsignal(WTERMSIG(status))));
  }
  throw Error(static_cast<ErrorCode>(WEXITSTATUS(status)),
              fmt::format("emscape-view ended with status {}", WEXITSTATUS(status)));
}

}  // namespace emscape::app
