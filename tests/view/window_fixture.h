/// The window in a virtual display: a fixture that runs scripts of the program there.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
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
    forgetLog();
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
  /// The next program writes the log anew.
  void forgetLog() {
    std::filesystem::remove(logFile());
    lines_.clear();
    read_ = 0;
  }
  /// Lines of the log so far, each parsed once.
  const std::vector<Json>& log() const {
    std::ifstream file(logFile(), std::ios::binary);
    file.seekg(static_cast<std::streamoff>(read_));
    for (std::string line; std::getline(file, line) && !file.eof();) {  // the last may be incomplete
      read_ += line.size() + 1;
      Json object = Json::parse(line, nullptr, false);
      if (!object.is_discarded()) lines_.push_back(std::move(object));
    }
    return lines_;
  }
  /// Those of an event.
  std::vector<Json> log(const std::string& event) const {
    std::vector<Json> lines;
    for (const Json& line : log()) {
      if (line["event"] == event) lines.push_back(line);
    }
    return lines;
  }
  /// The last of an event; null if there is none.
  Json last(const std::string& event) const {
    const std::vector<Json>& lines = log();
    const auto found =
        std::find_if(lines.rbegin(), lines.rend(), [&](const Json& line) { return line["event"] == event; });
    return found == lines.rend() ? Json() : *found;
  }
  /// Waits until the log meets a condition, at most a minute.
  static bool comes(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }
  bool comesToLog(const std::string& event) const {
    return comes([&] { return !last(event).is_null(); });
  }
  /// Number of stored views of unsaved edits.
  int keptViews() const {
    int views = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "state/emscape/autosave"))
      views += entry.path().extension() == ".json" ? 1 : 0;
    return views;
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

 private:
  mutable std::vector<Json> lines_;  // of the log
  mutable std::size_t read_ = 0;     // bytes of it
};

}  // namespace emscape::test
