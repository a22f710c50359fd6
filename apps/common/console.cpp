#include "apps/common/console.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <system_error>

#include "apps/common/interrupt.h"
#include "base/files/json_writing.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"

namespace emscape::app {
namespace {

constexpr std::chrono::seconds kProgressInterval(10);

std::mutex console_mutex;
std::string shown_line;     // the progress line on the screen; empty if there is none
std::string progress_line;  // its first part, of a Progress

/// The text that erases the progress line.
std::string clearLine() {
  return shown_line.empty() ? "" : "\r\033[K";
}

/// The beginning of a line that fits on the terminal: only one row of it could be erased.
std::string fitted(const std::string& line) {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  const auto isFollowingByte = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  std::size_t left = is_known ? size.ws_col - 1U : 79, end = 0;  // in characters
  for (; end < line.size(); ++end) {
    if (isFollowingByte(line[end])) continue;
    if (left-- == 0) break;
  }
  return line.substr(0, end);
}

/// Shows a line in place of the one on the screen. To be called with the console's mutex.
void showLine(const std::string& line) {
  const std::string clear = clearLine();
  shown_line = fitted(line);
  writeMessage(clear + shown_line);
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
  // Opened for the opposite direction, so that reading or writing fails, and so that the next open() gets
  // another number.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    static_cast<void>(::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

void printResult(const std::string& text) {
  {
    const std::lock_guard<std::mutex> lock(console_mutex);
    if (!shown_line.empty()) writeMessage(clearLine());
    shown_line.clear();
  }
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) failWriting(errno);
}

void printJson(const Json& result) {
  printResult(dumpJson(result, 2) + "\n");
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

Progress::Progress(const GlobalOptions& global, std::string task)
    : task_(std::move(task)),
      on_terminal_(isatty(STDERR_FILENO) != 0),
      visible_(!global.quiet),
      start_(Clock::now()),
      reported_(start_) {
  show(0);
}

Progress::~Progress() {
  if (!visible_ || !on_terminal_) return;
  std::lock_guard<std::mutex> lock(console_mutex);
  writeMessage(clearLine());
  shown_line.clear();
  progress_line.clear();
}

void Progress::show(double fraction) {
  if (!visible_) return;
  const Clock::time_point now = Clock::now();
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const std::string left = fraction > 0 ? duration(elapsed_s / fraction - elapsed_s) + " left" : "";
  std::lock_guard<std::mutex> lock(console_mutex);
  if (on_terminal_) {
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(fraction * kWidth);
    progress_line = fmt::format("{} [{:#<{}}{:.<{}}] {:.0f} % {}", task_, "", filled, "", kWidth - filled,
                                100 * fraction, left);
    showLine(progress_line);
    return;
  }
  if (fraction <= 0 || fraction >= 1 || now - reported_ < kProgressInterval) return;
  reported_ = now;
  writeMessage(fmt::format("emscape: {}: {:.0f} %, {}\n", task_, 100 * fraction, left));
}

WorkLine::WorkLine(const GlobalOptions& global, const Work& work) {
  if (global.quiet || isatty(STDERR_FILENO) == 0) return;
  try {
    thread_ = std::thread([this, &work] { follow(work); });
  } catch (const std::system_error&) {  // a limit of threads: the work goes on without the line
  }
}

WorkLine::~WorkLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_ended_ = true;
  }
  ended_.notify_one();
  thread_.join();
  const std::lock_guard<std::mutex> lock(console_mutex);
  writeMessage(clearLine());
  shown_line.clear();
}

void WorkLine::follow(const Work& work) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kInterval(500);
  constexpr int kTold_s = 2;  // a state that lasts this long is shown with its duration
  std::string state;
  Clock::time_point since = Clock::now();
  std::unique_lock<std::mutex> waiting(mutex_);
  while (!ended_.wait_for(waiting, kInterval, [this] { return has_ended_; })) {
    const WorkProgress progress = work.progress();
    std::string line = progress.part;
    if (!line.empty() && progress.fraction > 0 && progress.fraction < 1)
      line += fmt::format(": {:.0f} %", 100 * progress.fraction);
    const std::lock_guard<std::mutex> lock(console_mutex);
    if (!progress_line.empty()) line = progress_line + (line.empty() ? "" : "  ") + line;
    if (line != state) since = Clock::now();
    state = line;
    const auto lasted_s = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - since).count();
    if (!line.empty() && lasted_s >= kTold_s) line += fmt::format("  ({} s)", lasted_s);
    if (fitted(line) != shown_line) showLine(line);
  }
}

ProgressSink progressSink(const GlobalOptions& global) {
  struct Current {
    std::string step;
    std::unique_ptr<Progress> progress;
  };
  return [&global, current = std::make_shared<Current>()](const std::string& step, double fraction) {
    if (!current->progress || current->step != step) {
      current->progress.reset();  // erases its line before the next object draws its own
      current->step = step;
      current->progress = std::make_unique<Progress>(global, step);
    }
    current->progress->show(fraction);
    if (fraction >= 1) current->progress.reset();
  };
}

ProgressSink stoppingProgress(const GlobalOptions& global) {
  return [show = progressSink(global)](const std::string& step, double fraction) {
    stopIfInterrupted();
    show(step, fraction);
  };
}

}  // namespace emscape::app
