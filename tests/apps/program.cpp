#include "tests/apps/program.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

RunningProgram::RunningProgram(const Arguments& arguments, const std::string& shell_prefix) {
  std::string command = shell_prefix + " exec " + quoted(besideThisProgram("emscape"));
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " </dev/null >" + quoted(output_ / "out") + " 2>" + quoted(output_ / "err");
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

void RunningProgram::waitForALine() const {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (readFile(output_ / "out").find('\n') == std::string::npos && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

ProgramResult RunningProgram::wait() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readFile(output_ / "out"),
          readFile(output_ / "err")};
}

std::string besideThisProgram(const std::string& name) {
  return (fs::read_symlink("/proc/self/exe").parent_path() / name).string();
}

ProgramResult run(const Arguments& arguments, const std::string& shell_prefix) {
  return RunningProgram(arguments, shell_prefix).wait();
}

ProgramResult runWell(const Arguments& arguments, const std::string& shell_prefix) {
  ProgramResult result = run(arguments, shell_prefix);
  EXPECT_EQ(result.status, 0) << testing::PrintToString(arguments) << "\n" << result.err;
  return result;
}

std::string errorOfRun(const Arguments& arguments, int status, const std::string& shell_prefix) {
  const ProgramResult result = run(arguments, shell_prefix);
  EXPECT_EQ(result.status, status) << testing::PrintToString(arguments) << "\n" << result.err;
  return result.err;
}

Arguments joined(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const std::string& quick() {
  static const std::string file = shippedScenario("quick.yaml");
  return file;
}

std::string longScenario(const TemporaryFolder& folder, int duration_s) {
  std::string text = readFile(quick());
  text.replace(text.find("duration_s: 4"), 13, "duration_s: " + std::to_string(duration_s));
  text.replace(text.find("[40, 40, 20]"), 12, "[60, 60, 40]");
  return folder.write("long.yaml", text);
}

}  // namespace emscape::test
