/// Runs a script in JSON Lines format; each line is a command, or waits for a time or a condition.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/view/session/session.h"

namespace emscape::view {

/// Lines run in order. {"at_s": T} delays a line until T seconds after the start; wait_s, wait_frame and
/// wait_state delay the following lines. Empty lines and lines that begin with # are skipped.
class Script {
 public:
  Script() = default;
  /// @throws Error (bad_input) with file:line for a line that is not a command, or whose arguments are not
  /// allowed
  explicit Script(const std::string& file);

  bool finished() const { return next_ >= lines_.size(); }
  /// Runs the lines that are due. Called once per frame.
  /// @throws Error (check_failed) with file:line for an expectation that is not met, or a wait that timed out
  void run(Session& session, WindowControl& window, double now_s);
  /// Seconds until run() is to be called again; empty if the script is finished.
  std::optional<double> nextRun_s(double now_s) const;

 private:
  struct Line {
    SourceLocation location;
    Command command;
    std::optional<double> at_s;
  };
  bool waitIsOver(const Line& line, const Session& session, double now_s);
  void expect(const Line& line, const Session& session) const;
  void mark(const std::string& text, Session& session) const;

  std::vector<Line> lines_;
  std::size_t next_ = 0;
  std::optional<double> waits_since_s_;  // start of waiting in line next_
  int frames_to_wait_ = 0;               // until the window has processed the injected events
};

}  // namespace emscape::view
