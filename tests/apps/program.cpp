#include "tests/apps/program.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

fs::path makeTemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "emscape_apps_XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed");
  return name;
}

}  // namespace

RunningProgram::RunningProgram(const Arguments& arguments, const std::string& shell_prefix)
    : output_(makeTemporaryFolder()) {
  std::string command = shell_prefix + " exec " + quoted(besideThisProgram("emscape"));
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command +=
      " </dev/null >" + quoted((output_ / "out").string()) + " 2>" + quoted((output_ / "err").string());
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("fork failed");
  if (process_ == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
}

void RunningProgram::signal(int number) const {
  kill(process_, number);
}

ProgramResult RunningProgram::wait() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  ProgramResult result{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                       readFile(output_ / "out"), readFile(output_ / "err")};
  fs::remove_all(output_);
  return result;
}

std::string besideThisProgram(const std::string& name) {
  return (fs::read_symlink("/proc/self/exe").parent_path() / name).string();
}

ProgramResult run(const Arguments& arguments, const std::string& shell_prefix) {
  return RunningProgram(arguments, shell_prefix).wait();
}

TemporaryFolder::TemporaryFolder() : path_(makeTemporaryFolder()) {}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(path_)) {
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), path_).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string readFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void writeFile(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string shippedScenario(const std::string& name) {
  return (fs::path(EMSCAPE_SOURCE_DIR) / "scenarios" / name).string();
}

const std::string& quick() {
  static const std::string file = shippedScenario("quick.yaml");
  return file;
}

std::string longScenario(const TemporaryFolder& folder, int duration_s) {
  std::string text = readFile(quick());
  text.replace(text.find("duration_s: 4"), 13, "duration_s: " + std::to_string(duration_s));
  text.replace(text.find("[40, 40, 20]"), 12, "[60, 60, 40]");
  const std::string file = folder / "long.yaml";
  writeFile(file, text);
  return file;
}

}  // namespace emscape::test
