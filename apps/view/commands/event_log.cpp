#include "apps/view/commands/event_log.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "base/files/json_writing.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Time since this process was started, in units of the system's tick (10 ms).
SteadyClock::duration processAge() {
  constexpr int kStartTime = 22;  // field of /proc/self/stat, in ticks since the system's start
  std::ifstream stat("/proc/self/stat");
  std::string field;
  std::getline(stat, field, ')');  // the program's name may contain blanks
  for (int n = 3; n <= kStartTime; ++n) stat >> field;
  timespec now{};
  if (!stat || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return {};
  const double age_s = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
                       std::strtod(field.c_str(), nullptr) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return std::chrono::duration_cast<SteadyClock::duration>(
      std::chrono::duration<double>(std::max(age_s, 0.0)));
}

}  // namespace

EventLog::EventLog() : start_(SteadyClock::now() - processAge()) {}

EventLog::EventLog(const std::string& file) : EventLog() {
  std::string first;
  if (std::filesystem::is_regular_file(file) && std::ifstream(file) >> first &&
      first.rfind("{\"t_s\"", 0) != 0) {
    throw Error(ErrorCode::usage, "--log: " + file +
                                      " is a file that emscape did not write; give another name, or move it "
                                      "away first");
  }
  out_.emplace(file);
  out_->cut(0);
}

double EventLog::now_s() const {
  return std::chrono::duration<double>(SteadyClock::now() - start_).count();
}

void EventLog::write(const char* event, const Json& fields) {
  if (!open()) return;
  Json line{{"t_s", std::round(now_s() * 1e4) / 1e4}, {"event", event}};
  line.update(fields);
  out_->append(dumpJson(line) + "\n");  // lines are complete after a crash of the program
}

double processorTime_s() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

double residentMemory_mib() {
  std::ifstream statm("/proc/self/statm");
  long long total_pages = 0, resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

}  // namespace emscape::view
