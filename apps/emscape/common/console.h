/// Standard output and error: results, log lines, progress.
#pragma once

#include <fmt/core.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/emscape/common/command.h"
#include "emscape/base/progress.h"

namespace emscape::app {

using Json = nlohmann::ordered_json;

/// Sends the libraries' messages to standard error: warnings always, the rest unless --quiet.
void installLog(const GlobalOptions& global);

/// Opens standard streams that are closed at the start, so that no other file gets their numbers and writing
/// to them fails. To be called before any other file is opened.
void openStandardStreams();

/// Writes text to standard output, which carries the result. @throws Error (other) if it cannot be written
void printResult(const std::string& text);

/// While an object lives, results of the calling thread are collected in a text instead of being written to
/// standard output.
class CapturedResult {
 public:
  CapturedResult();
  ~CapturedResult();
  CapturedResult(const CapturedResult&) = delete;
  CapturedResult& operator=(const CapturedResult&) = delete;

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::string* outer_;
};

template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  printResult(fmt::format(format, std::forward<Arguments>(arguments)...));
}
/// A finite number, or null.
Json number(double value);
Json number(const std::optional<double>& value);
/// Prints JSON as the only content of standard output. @throws Error (other)
void printJson(const Json& result);
/// A cell of a CSV file, quoted if it contains a comma or a quote.
std::string csvText(const std::string& text);
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

/// A progress sink for a library: that of the options, otherwise one that owns a new Progress for each step.
ProgressSink progressSink(const GlobalOptions& global);

/// Logs warnings. Warnings that differ only in the emitter and in numbers are merged into one that names the
/// first five emitters and counts the others. Its numbers are those of each emitter, or their range if an
/// emitter has several warnings, as over time, or is not named.
void logWarnings(const std::vector<std::string>& warnings);
/// The lines that logWarnings() writes.
std::vector<std::string> joinedWarnings(const std::vector<std::string>& warnings);

}  // namespace emscape::app
