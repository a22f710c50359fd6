#include "apps/emscape/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <mutex>
#include <system_error>

#include "emscape/base/error.h"
#include "emscape/base/log.h"

namespace emscape::app {
namespace {

std::mutex console_mutex;
std::string shown_line;  // the progress line on the screen; empty if there is none

/// What erases the progress line.
std::string clearLine() {
  return shown_line.empty() ? "" : "\r\033[K";
}

[[noreturn]] void failWriting(int error_number) {
  throw Error(ErrorCode::other, "standard output: cannot write the result: " +
                                    std::generic_category().message(error_number == 0 ? EIO : error_number));
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
    writeMessage(fmt::format("{}emscape: {}{}\n{}", clearLine(),
                             level == LogLevel::warning ? "warning: " : "", message, shown_line));
  });
}

void openStandardStreams() {
  // Opened the wrong way round: whoever reads or writes is told, and the next open() takes another number.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    static_cast<void>(::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

void printResult(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) failWriting(errno);
}

void printJson(const Json& result) {
  printResult(result.dump(2) + "\n");
  finishResult();
}

void finishResult() {
  errno = 0;
  std::cout.flush();  // CLI11 prints help texts through it
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) failWriting(errno);
}

void writeMessage(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
  std::clearerr(stderr);
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
  writeMessage(clearLine());
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
  const std::string clear = clearLine();
  shown_line =
      fmt::format("{} [{:#<{}}{:.<{}}] {}/{} {}", task_, "", filled, "", kWidth - filled, done, total_, left);
  writeMessage(clear + shown_line);
}

}  // namespace emscape::app
