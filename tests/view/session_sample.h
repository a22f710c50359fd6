/// Sessions without a window, for the tests of this module.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "apps/view/session/session.h"
#include "emscape/base/backend.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::view::test {

using emscape::test::errorOf;
using emscape::test::readFile;
using emscape::test::shippedScenario;
using emscape::test::TemporaryFolder;
using emscape::test::writeFile;

/// Records what a session requests.
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

/// A temporary folder that is also XDG_STATE_HOME.
class StateFolder : public TemporaryFolder {
 public:
  StateFolder() { setenv("XDG_STATE_HOME", path().c_str(), 1); }
  ~StateFolder() { unsetenv("XDG_STATE_HOME"); }
};

inline playback::ComputeTarget cpu() {
  return {resolveBackend(Backend::cpu), volume::VoxelPrecision::float32};
}

inline ViewOptions optionsFor(const std::string& input, render::ImageSize size = {320, 240}) {
  ViewOptions options;
  options.view.input = input;
  options.view.size = size;
  return options;
}

/// A session with everything it needs. Its time passes only during waits.
class SessionSample {
 public:
  explicit SessionSample(const ViewOptions& options) : session(make(options)) {
    session->setPictureSize(options.view.size);
  }
  /// A settled session on scenarios/NAME with a quarter of the rays.
  explicit SessionSample(const std::string& name, std::vector<scenario::Edit> edits = {})
      : SessionSample(quarterOptions(name, std::move(edits))) {
    settle();
  }

  Session& operator*() const { return *session; }
  Session* operator->() const { return session.get(); }
  /// Another session of the same window.
  std::unique_ptr<Session> make(const ViewOptions& options) {
    return std::make_unique<Session>(
        options, cpu(), window, log, [this] { wake(); }, files);
  }

  /// Updates until a condition holds. @return false after a minute; the test has failed then
  bool waitUntil(const std::function<bool()>& condition) {
    const auto begin = std::chrono::steady_clock::now();
    while (session->update(), !condition()) {
      if (std::chrono::steady_clock::now() - begin > std::chrono::minutes(1)) {
        ADD_FAILURE() << "after a minute: " << session->report().dump();
        return false;
      }
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(10));
    }
    return true;
  }
  /// Waits until the picture shows everything requested.
  bool settle() {
    return waitUntil(
        [this] { return session->settled() && session->report()["asked_s"] == session->status().shown_s; });
  }
  /// Executes a command and waits for its edits. @return its error; may be empty
  std::string perform(const std::string& command) {
    session->perform(parseCommand(command));
    waitUntil([this] { return !session->isAnswering(); });
    return error();
  }
  std::string error() const { return session->notice().is_error ? session->notice().text : ""; }

 private:
  static ViewOptions quarterOptions(const std::string& name, std::vector<scenario::Edit> edits) {
    ViewOptions options = optionsFor(shippedScenario(name), {240, 180});
    options.view.edits = std::move(edits);
    options.view.pattern = render::Pattern::quarter;
    return options;
  }
  void wake() {
    const std::lock_guard<std::mutex> lock(mutex_);
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;

 public:
  NoWindow window;
  EventLog log;
  std::shared_ptr<Files> files = std::make_shared<Files>();
  std::unique_ptr<Session> session;  // destroyed first
};

/// A session on scenarios/quick.yaml.
class SessionTest : public testing::Test, protected SessionSample {
 protected:
  SessionTest() : SessionSample(optionsFor(shippedScenario("quick.yaml"), {160, 120})) { settle(); }
};

}  // namespace emscape::view::test
