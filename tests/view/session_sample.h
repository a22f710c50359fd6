/// A session that is shown, and commands to it as scripts give them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/view/session_samples.h"

namespace emscape::view::test {

/// Waits for what each command brings.
class SessionSample {
 public:
  explicit SessionSample(const std::string& scenario, std::vector<scenario::Edit> edits = {})
      : shown_(optionsOf(scenario, std::move(edits))), window(shown_.window), session(shown_.session.get()) {
    settle();
  }

  void waitUntil(const std::function<bool()>& condition) {
    ASSERT_TRUE(waitFor(*session, condition)) << session->report().dump();
  }
  /// The picture shows everything.
  void settle() { ASSERT_TRUE(waitUntilSettled(*session)) << session->report().dump(); }
  void perform(const std::string& command) {
    session->perform(parseCommand(command));
    waitUntil([this] { return !session->isAnswering(); });
  }
  std::string error() const { return session->report()["error"].get<std::string>(); }

 private:
  static ViewOptions optionsOf(const std::string& scenario, std::vector<scenario::Edit> edits) {
    ViewOptions options = optionsFor(shippedScenario(scenario), {240, 180});
    options.view.edits = std::move(edits);
    options.controller.pattern = render::Pattern::quarter;
    return options;
  }

  Shown shown_;

 public:
  NoWindow& window;
  Session* session;
};

}  // namespace emscape::view::test
