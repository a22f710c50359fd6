/// Real keys and mouse buttons: X events of the server, in a window that a window manager manages.
#pragma once

#include <filesystem>
#include <functional>

#include "tests/view/window_fixture.h"

namespace emscape::test {

/// Position in the window.
struct Place {
  int x, y;
};
inline std::string at(const Place& place) {
  return " mousemove --window $w " + std::to_string(place.x) + " " + std::to_string(place.y);
}
inline std::string click(const Place& place) {
  return at(place) + " click 1";
}
inline std::string controlClick(const Place& place) {
  return at(place) + " keydown ctrl click 1 keyup ctrl";
}
inline std::string doubleClick(const Place& place) {
  return at(place) + " click --repeat 2 --delay 60 1";
}
inline std::string drag(const Place& place, int right_px) {
  return at(place) + " mousedown 1" + at({place.x + right_px / 2, place.y}) +
         at({place.x + right_px, place.y}) + " mouseup 1";
}
inline std::string type(const std::string& text) {
  return " type --args 1 --delay 20 -- '" + text + "'";
}

class WindowManager {
 public:
  explicit WindowManager(const std::string& display) : process_(fork()) {
    if (process_ != 0) return;
    setenv("DISPLAY", display.c_str(), 1);
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execlp("openbox", "openbox", "--sm-disable", static_cast<char*>(nullptr));
    _exit(127);
  }
  ~WindowManager() {
    ::kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  WindowManager(const WindowManager&) = delete;
  WindowManager& operator=(const WindowManager&) = delete;

 private:
  const pid_t process_;
};

class RealInput : public Window {
 protected:
  void SetUp() override {
    for (const char* program : {"xdotool", "openbox"}) {
      if (!hasProgram(program)) GTEST_SKIP() << program << " is not installed";
    }
    Window::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    manager_ = std::make_unique<WindowManager>(display_->name());
    ASSERT_TRUE(comes([&] { return xdotool("get_desktop"); })) << "openbox did not start";
  }
  void TearDown() override {
    if (program_) kill(SIGKILL);
    manager_.reset();
  }

  /// Opens an input, and waits until it is shown and has the focus.
  void open(const std::string& input) {
    start(viewOf(input, R"({"do":"wait_state","state":"exact"}
{"do":"mark","text":"ready"}
{"do":"wait_s","seconds":300}
)"));
    ASSERT_TRUE(comesToLog("mark"));
    activate();
  }
  /// The same as a user does, without a script: questions are asked.
  void openByHand(const std::string& input) {
    start({"view", input, "--size", "", "--backend", "cpu", "--log", logFile()});
    ASSERT_TRUE(reports("program", "IDLE"));
    activate();
  }
  void start(Arguments arguments) {
    forgetLog();
    arguments[3] = "1000x800";
    program_ = std::make_unique<RunningProgram>(arguments, environment());
  }
  void activate() const {
    ASSERT_TRUE(xdotool("search --sync --onlyvisible --name emscape windowactivate --sync"));
  }
  /// Runs commands of xdotool; $w is the window.
  bool xdotool(const std::string& commands) const {
    const std::string line = environment() + "w=$(xdotool search --onlyvisible --name emscape);" +
                             "timeout 60 xdotool " + commands + " >/dev/null 2>&1";
    return std::system(line.c_str()) == 0;
  }
  void kill(int signal) {
    program_->signal(signal);
    EXPECT_EQ(program_->wait().status, 128 + signal);
    program_.reset();
  }
  /// Ends the program as a session's end does. @return its last report
  Json end() {
    kill(SIGTERM);
    return last("end");
  }

  /// Waits until a value of the report, which each frame logs, meets a condition.
  bool reports(const std::string& key, const std::function<bool(const Json&)>& condition) const {
    return comes([&] {
      const Json frame = last("frame");
      return !frame.is_null() && condition(frame.value(key, Json()));
    });
  }
  bool reports(const std::string& key, const Json& expected) const {
    return reports(key, [&](const Json& value) { return value == expected; });
  }
  /// Presses keys that open a dialog, and waits until its text has the cursor.
  /// @param verb  of the command that they run
  bool opens(const std::string& keys, const std::string& verb) const {
    constexpr int kFrames = 4;  // until a text that lost the cursor to the keys is no longer told
    return xdotool("key " + keys) && comes([&] {
             int frames = 0;
             bool is_typing = false;
             const std::vector<Json>& lines = log();  // read once: the next call may move them
             for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
               if ((*line)["event"] == "command")
                 return (*line)["do"] == verb && frames >= kFrames && is_typing;
               if ((*line)["event"] == "frame" && ++frames == 1) is_typing = (*line)["typing"];
             }
             return false;
           });
  }
  /// The commands since the input was shown.
  std::string commands() const {
    std::string names;
    for (const Json& line : log()) {
      if (line["event"] == "mark") names.clear();
      if (line["event"] == "command" && line["do"] != "wait_s")
        names += (names.empty() ? "" : " ") + line["do"].get<std::string>();
    }
    return names;
  }
  bool commandsBecome(const std::string& names) const {
    return comes([&] { return commands().size() >= names.size(); }) && commands() == names;
  }

  std::unique_ptr<WindowManager> manager_;
  std::unique_ptr<RunningProgram> program_;
};

}  // namespace emscape::test
