/// Standard output and error: results, log lines, progress.
#pragma once

#include <fmt/core.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "apps/common/command.h"
#include "emscape/base/progress.h"
#include "emscape/base/work.h"

namespace emscape::app {

using Json = nlohmann::ordered_json;

/// Sends the libraries' messages to standard error: warnings always, the rest unless --quiet.
void installLog(const GlobalOptions& global);

/// Opens standard streams that are closed at the start, so that no other file gets their numbers and writing
/// to them fails. To be called before any other file is opened.
void openStandardStreams();

/// Writes text to standard output, which carries the result. @throws Error (other) if it cannot be written
void printResult(const std::string& text);

template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  printResult(fmt::format(format, std::forward<Arguments>(arguments)...));
}
/// Prints JSON as the only content of standard output. @throws Error (other)
void printJson(const Json& result);
/// Flushes standard output. @throws Error (other) if any part of the result could not be written
void finishResult();

/// Writes text to standard error. A message that cannot be written is dropped.
void writeMessage(const std::string& text);
template <class... Arguments>
void printMessage(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  writeMessage(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Reports the task, its progress and the remaining time on standard error: on a terminal in a line that is
/// rewritten below the log, elsewhere as one line every ten seconds. Silent with --quiet. For use by one
/// thread.
class Progress {
 public:
  Progress(const GlobalOptions& global, std::string task);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param fraction  completed fraction of the work, 0..1
  void show(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  const std::string task_;
  const bool on_terminal_;
  const bool visible_;
  const Clock::time_point start_;
  Clock::time_point reported_;  // time of the last line that is not rewritten
};

/// While it exists, shows on a terminal which part of a piece of work takes its time, and for how long,
/// beside the progress. Silent with --quiet.
class WorkLine {
 public:
  /// @param work  must outlive this
  WorkLine(const GlobalOptions& global, const Work& work);
  ~WorkLine();
  WorkLine(const WorkLine&) = delete;
  WorkLine& operator=(const WorkLine&) = delete;

 private:
  void follow(const Work& work);

  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::thread thread_;
};

/// A progress sink for a library that owns a new Progress for each step.
ProgressSink progressSink(const GlobalOptions& global);
/// The same; each call throws Stopped if the user has stopped the program.
ProgressSink stoppingProgress(const GlobalOptions& global);

}  // namespace emscape::app
