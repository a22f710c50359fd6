#include "apps/emscape/console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

#include "base/log.h"

namespace emscape::app {
namespace {

std::mutex console_mutex;
std::string shown_line;  // the progress line on the screen; empty if there is none

void clearLine() {
  if (!shown_line.empty()) fmt::print(stderr, "\r\033[K");
}

std::string duration(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

void installLog(const GlobalOptions& global) {
  const bool quiet = global.quiet;
  setLogSink([quiet](LogLevel level, const std::string& message) {
    if (level == LogLevel::debug || (quiet && level == LogLevel::info)) return;
    std::lock_guard<std::mutex> lock(console_mutex);
    clearLine();
    fmt::print(stderr, "emscape: {}{}\n{}", level == LogLevel::warning ? "warning: " : "", message,
               shown_line);
    std::fflush(stderr);
  });
}

void printJson(const Json& result) {
  fmt::print("{}\n", result.dump(2));
  std::fflush(stdout);
}

ProgressBar::ProgressBar(const GlobalOptions& global, std::string task, int total)
    : task_(std::move(task)),
      total_(total),
      visible_(!global.quiet && isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {
  show(0);
}

ProgressBar::~ProgressBar() {
  if (!visible_) return;
  std::lock_guard<std::mutex> lock(console_mutex);
  clearLine();
  shown_line.clear();
}

void ProgressBar::show(int done) {
  if (!visible_ || total_ <= 0) return;
  constexpr int kWidth = 30;
  const double fraction = static_cast<double>(done) / total_;
  const int filled = static_cast<int>(fraction * kWidth);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string left = done > 0 ? duration(elapsed_s / fraction - elapsed_s) + " left" : "";
  std::lock_guard<std::mutex> lock(console_mutex);
  clearLine();
  shown_line =
      fmt::format("{} [{:#<{}}{:.<{}}] {}/{} {}", task_, "", filled, "", kWidth - filled, done, total_, left);
  fmt::print(stderr, "{}", shown_line);
  std::fflush(stderr);
}

}  // namespace emscape::app
