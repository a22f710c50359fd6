/// A session without a window.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

#include "apps/view/session.h"

namespace emscape::view {

/// Takes what commands ask of a window and does nothing.
class NoWindow : public WindowControl {
 public:
  void resize(int, int) override {}
  double scale() const override { return 1; }
  void setScale(double) override {}
  void screenshot(const std::string&) override {}
  void setClipboard(const std::string&) override {}
  void quit() override {}
  void press(const KeyChord&) override {}
  void inject(const InputEvent&) override {}
};

/// A session on scenarios/quick.yaml. Time passes only in update().
class SessionTest : public testing::Test {
 protected:
  SessionTest() : session(options(), playback::ComputeTarget{}, window_, log_, [this] { wake(); }) {
    session.setPictureSize({160, 120});
    settle();
  }

  static ViewOptions options() {
    ViewOptions options;
    options.input = EMSCAPE_SOURCE_DIR "/scenarios/quick.yaml";
    return options;
  }
  /// Carries a command out and waits for its edits.
  void perform(const std::string& text) {
    session.perform(parseCommand(text));
    if (session.isAnswering()) waitUntil([this] { return !session.isAnswering(); });
  }
  /// Updates until a condition holds.
  void waitUntil(const std::function<bool()>& condition) {
    const auto begin = std::chrono::steady_clock::now();
    while (session.update(), !condition()) {
      ASSERT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60))
          << session.report().dump();
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(10));
    }
  }
  void settle() {
    // What was asked for last has reached the workers as soon as perform() has returned.
    waitUntil(
        [this] { return session.settled() && session.report()["asked_s"] == session.status().shown_s; });
  }
  std::string error() const { return session.notice().is_error ? session.notice().text : ""; }

 private:
  void wake() {
    const std::lock_guard<std::mutex> lock(mutex_);
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  NoWindow window_;
  EventLog log_;

 protected:
  Session session;  // the first to go
};

}  // namespace emscape::view
