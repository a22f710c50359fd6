#include "apps/emscape/common/console.h"

#include <fcntl.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <regex>
#include <system_error>
#include <unordered_map>
#include <unordered_set>

#include "base/files/json_writing.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"

namespace emscape::app {
namespace {

constexpr std::chrono::seconds kProgressInterval(10);

std::mutex console_mutex;
std::string shown_line;  // the progress line on the screen; empty if there is none
thread_local std::string* captured_result = nullptr;

/// The text that erases the progress line.
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
  // Opened for the opposite direction, so that reading or writing fails, and so that the next open() gets
  // another number.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    static_cast<void>(::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

CapturedResult::CapturedResult() : outer_(captured_result) {
  captured_result = &text_;
}

CapturedResult::~CapturedResult() {
  captured_result = outer_;
}

void printResult(const std::string& text) {
  if (captured_result != nullptr) {
    *captured_result += text;
    return;
  }
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) failWriting(errno);
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

void printJson(const Json& result) {
  printResult(dumpJson(result, 2) + "\n");
  finishResult();
}

std::string csvText(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

void finishResult() {
  if (captured_result != nullptr) return;
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
    const std::string clear = clearLine();
    shown_line = fmt::format("{} [{:#<{}}{:.<{}}] {:.0f} % {}", task_, "", filled, "", kWidth - filled,
                             100 * fraction, left);
    writeMessage(clear + shown_line);
    return;
  }
  if (fraction <= 0 || fraction >= 1 || now - reported_ < kProgressInterval) return;
  reported_ = now;
  writeMessage(fmt::format("emscape: {}: {:.0f} %, {}\n", task_, 100 * fraction, left));
}

ProgressSink progressSink(const GlobalOptions& global) {
  if (global.progress) return global.progress;
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

std::vector<std::string> joinedWarnings(const std::vector<std::string>& warnings) {
  static const std::regex kOfEmitter("emitter '([^']*)': (.*)");
  static const std::regex kNumber(R"((\B-)?\b\d+(\.\d+)?\b)");
  constexpr std::size_t kMaxNames = 5;
  struct Kind {
    std::string form;                               // the text with '#' for each number
    std::unordered_set<std::string> emitters;       // empty: the warning of no emitter
    std::vector<std::string> names;                 // of the first emitters
    std::size_t count = 0;                          // warnings of this form
    std::vector<std::vector<std::string>> numbers;  // by position in the text, one per warning
  };
  std::vector<Kind> kinds;
  std::unordered_map<std::string, std::size_t> kind_of_form;  // of the warnings of emitters
  for (const std::string& warning : warnings) {
    std::smatch parts;
    if (!std::regex_match(warning, parts, kOfEmitter)) {
      kinds.push_back({warning, {}, {}, 1, {}});
      continue;
    }
    const std::string text = parts[2], emitter = "'" + parts[1].str() + "'";
    const std::string form = std::regex_replace(text, kNumber, "#");
    const auto [known, is_new] = kind_of_form.emplace(form, kinds.size());
    if (is_new) kinds.push_back({form, {}, {}, 0, {}});
    Kind& kind = kinds[known->second];
    if (kind.emitters.insert(emitter).second && kind.names.size() < kMaxNames) kind.names.push_back(emitter);
    ++kind.count;
    std::size_t place = 0;
    for (std::sregex_iterator number(text.begin(), text.end(), kNumber), end; number != end;
         ++number, ++place) {
      if (kind.numbers.size() <= place) kind.numbers.emplace_back();
      kind.numbers[place].push_back(number->str());
    }
  }
  std::vector<std::string> lines;
  for (const Kind& kind : kinds) {
    if (kind.emitters.empty()) {
      lines.push_back(kind.form);
      continue;
    }
    const std::size_t others = kind.emitters.size() - kind.names.size();
    std::string line =
        fmt::format("emitter{} {}", kind.emitters.size() > 1 ? "s" : "", fmt::join(kind.names, ", "));
    line += others == 0 ? ": " : fmt::format(" and {} other{}: ", others, others > 1 ? "s" : "");
    std::size_t place = 0;
    for (const char character : kind.form) {
      if (character != '#' || place >= kind.numbers.size()) {
        line += character;
        continue;
      }
      const std::vector<std::string>& numbers = kind.numbers[place++];
      const auto [min, max] =
          std::minmax_element(numbers.begin(), numbers.end(),
                              [](const auto& a, const auto& b) { return std::stod(a) < std::stod(b); });
      const bool is_one_each = kind.count == kind.names.size();
      line += *min == *max  ? *min
              : is_one_each ? fmt::format("{}", fmt::join(numbers, ", "))
                            : fmt::format("{} to {}", *min, *max);
    }
    lines.push_back(line);
  }
  return lines;
}

void logWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& line : joinedWarnings(warnings)) logWarning(line);
}

}  // namespace emscape::app
