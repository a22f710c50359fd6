/// Sessions without a window, for the tests of this module.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "apps/view/session.h"
#include "emscape/base/backend.h"

namespace emscape::view::test {

/// Notes what a session asks for.
class NoWindow : public WindowControl {
 public:
  void resize(int, int) override {}
  double scale() const override { return 1; }
  void setScale(double) override {}
  void screenshot(const std::string&) override {}
  void setClipboard(const std::string& text) override { clipboard = text; }
  void quit() override { has_quit = true; }
  void press(const KeyChord&) override {}
  void inject(const InputEvent&) override {}

  std::string clipboard;
  bool has_quit = false;
};

/// A folder of the running test's own that is also XDG_STATE_HOME.
class StateFolder {
 public:
  StateFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "emscape-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
    setenv("XDG_STATE_HOME", path_.c_str(), 1);
  }
  ~StateFolder() {
    unsetenv("XDG_STATE_HOME");
    std::filesystem::remove_all(path_);
  }
  StateFolder(const StateFolder&) = delete;
  StateFolder& operator=(const StateFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string shippedScenario(const std::string& name) {
  return std::string(EMSCAPE_SOURCE_DIR "/scenarios/") + name;
}

inline std::string readText(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline playback::ComputeTarget cpu() {
  return {resolveBackend(Backend::cpu), volume::VoxelPrecision::float32};
}

/// Lets a session work until a condition holds; false after a minute.
inline bool waitFor(Session& session, const std::function<bool()>& condition) {
  for (int i = 0; i < 12000; ++i) {
    session.update();
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}
inline bool waitUntilSettled(Session& session) {
  return waitFor(session, [&session] { return session.settled(); });
}

/// A session and all that it needs.
struct Shown {
  NoWindow window;
  EventLog log;
  std::shared_ptr<Files> files = std::make_shared<Files>();
  std::unique_ptr<Session> session;

  explicit Shown(const ViewOptions& options) {
    session = make(options);
    session->setPictureSize(options.view.size);
  }
  std::unique_ptr<Session> make(const ViewOptions& options) {
    return std::make_unique<Session>(
        options, cpu(), window, log, [] {}, files);
  }
  Session& operator*() const { return *session; }
  Session* operator->() const { return session.get(); }
  /// The command's fault; empty if there is none.
  std::string perform(const std::string& command) {
    session->perform({"back"});
    session->perform(parseCommand(command));
    waitFor(*session, [this] { return !session->isAnswering(); });
    return session->notice().is_error ? session->notice().text : "";
  }
};

inline ViewOptions optionsFor(const std::string& input, render::ImageSize size = {320, 240}) {
  ViewOptions options;
  options.input = input;
  options.view.size = size;
  return options;
}

}  // namespace emscape::view::test
