/// emscape view: starts the window, a program of its own, so that this one needs no OpenGL.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "apps/emscape/command.h"

namespace emscape::app {
namespace {

/// Becomes emscape-view, which lies beside this program.
[[noreturn]] void startWindow(const GlobalOptions& global, const std::vector<std::string>& arguments) {
  std::error_code failed;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::string program = (here.parent_path() / "emscape-view").string();
  std::vector<std::string> words{program};
  if (global.backend != "auto") words.insert(words.end(), {"--backend", global.backend});
  if (global.threads != 0) words.insert(words.end(), {"--threads", std::to_string(global.threads)});
  if (global.quiet) words.emplace_back("--quiet");
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  const int cause = errno;
  throw Error(ErrorCode::device,
              cause == ENOENT
                  ? program +
                        " is not there: it is built where GLFW, Dear ImGui and libepoxy are found "
                        "(-DEMSCAPE_VIEW=ON); 'emscape render' draws pictures and videos without a window"
                  : program + ": " + std::strerror(cause));
}

}  // namespace

void addView(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("view", "Show a scenario or volumes in a window");
  command->set_help_flag();  // the window's own help
  command->prefix_command();
  command->callback([command, &global, &action] {
    action = [command, &global]() -> int { startWindow(global, command->remaining()); };
  });
}

}  // namespace emscape::app
