/// Standard output and error: results, log lines, a progress bar.
#pragma once

#include <fmt/core.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/emscape/command.h"

namespace emscape::app {

using Json = nlohmann::ordered_json;

/// Sends the libraries' messages to standard error: warnings always, the rest unless --quiet.
void installLog(const GlobalOptions& global);

/// Gives the program three usable standard streams, whatever it was started with: a closed one is opened so
/// that no other file takes its number, and so that writing to it fails. To be called first.
void openStandardStreams();

/// Writes text to standard output, which carries the result. @throws Error (other) if it cannot be written
void printResult(const std::string& text);
template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  printResult(fmt::format(format, std::forward<Arguments>(arguments)...));
}
/// The result as JSON, alone on standard output. @throws Error (other)
void printJson(const Json& result);
/// Flushes standard output. @throws Error (other) if any part of the result could not be written
void finishResult();

/// Writes text to standard error. A message that cannot be written is lost: the work goes on.
void writeMessage(const std::string& text);
template <class... Arguments>
void printMessage(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  writeMessage(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// A line on standard error that says what is being done, how far it is and how long it will take. Only on a
/// terminal, and not with --quiet; log lines stand above it. One thread uses it.
class ProgressBar {
 public:
  ProgressBar(const GlobalOptions& global, std::string task, int total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param done  0..total
  void show(int done);

 private:
  const std::string task_;
  const int total_;
  const bool visible_;
  const std::chrono::steady_clock::time_point start_;
};

}  // namespace emscape::app
