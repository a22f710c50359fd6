/// Standard output and error: results, log lines, a progress bar.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/emscape/command.h"

namespace emscape::app {

using Json = nlohmann::ordered_json;

/// Sends the libraries' messages to standard error: warnings always, the rest unless --quiet.
void installLog(const GlobalOptions& global);

/// The result alone on standard output.
void printJson(const Json& result);

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
