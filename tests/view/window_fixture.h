/// The window in a virtual display: a fixture that runs scripts of the program there.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/program.h"

namespace emscape::test {

using Json = nlohmann::json;

inline bool hasProgram(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

/// An X server without a screen.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    int ends[2];
    if (pipe(ends) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      const int nowhere = open("/dev/null", O_RDWR);
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
      const std::string number = std::to_string(ends[1]);
      // Without -noreset it starts anew after its last client, and refuses one that comes meanwhile.
      execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-noreset", "-screen", "0", "1920x1200x24",
             "-nolisten", "tcp", static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) name_ += c;
    close(ends[0]);
  }
  ~VirtualDisplay() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// ":7"; ":" if it did not start.
  std::string name() const { return ":" + name_; }

 private:
  pid_t process_ = -1;
  std::string name_;
};

class Window : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasProgram("Xvfb")) GTEST_SKIP() << "Xvfb is not installed";
    display_ = std::make_unique<VirtualDisplay>();
    ASSERT_GT(display_->name().size(), 1U) << "Xvfb did not start";
  }

  std::string environment() const {
    // The OpenGL driver is unloaded before its leaks can be distinguished from the program's.
    return "export DISPLAY=" + display_->name() +
           " LP_NUM_THREADS=1 LIBGL_ALWAYS_SOFTWARE=1 ASAN_OPTIONS=detect_leaks=0 XDG_STATE_HOME=" +
           (folder_ / "state") + ";";
  }

  Arguments viewOf(const std::string& input, const std::string& script) {
    writeFile(folder_ / "script.jsonl", script);
    return {"view",  input,    "--size", "640x480", "--backend", "cpu", "--script", folder_ / "script.jsonl",
            "--log", logFile()};
  }

  /// Runs a script to its end.
  ProgramResult runScript(const std::string& script, const Arguments& more = {}) {
    return run(joined(viewOf(quick(), script), more), environment());
  }

  /// Runs a script and quits; the test fails if a step of it does.
  void play(const std::string& script, const Arguments& more = {}) {
    const ProgramResult result = runScript(script + R"({"do":"quit"})"
                                                    "\n",
                                           more);
    EXPECT_EQ(result.status, 0) << result.err;
  }

  std::string logFile() const { return folder_ / "log.jsonl"; }
  /// Lines of the log; with a name those of that event.
  std::vector<Json> log(const std::string& event = "") const {
    std::vector<Json> lines;
    std::istringstream text(readFile(logFile()));
    for (std::string line; std::getline(text, line);) {
      Json object = Json::parse(line, nullptr, false);
      if (!object.is_discarded() && (event.empty() || object["event"] == event)) lines.push_back(object);
    }
    return lines;
  }
  /// Waits for an event, at most a minute. @return false if it did not come
  bool comesToLog(const std::string& event) const {
    for (int i = 0; i < 600 && log(event).empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return !log(event).empty();
  }
  /// "BUSY RESTORE IDLE": the states in the order in which they came.
  std::string states() const {
    std::string states;
    for (const Json& change : log("state"))
      states += (states.empty() ? "" : " ") + change["to"].get<std::string>();
    return states;
  }

  TemporaryFolder folder_;
  std::unique_ptr<VirtualDisplay> display_;
};

}  // namespace emscape::test
