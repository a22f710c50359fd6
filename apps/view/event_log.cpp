#include "apps/view/event_log.h"

#include <unistd.h>

#include <cmath>

#include "emscape/base/error.h"

namespace emscape::view {

EventLog::EventLog(const std::string& file) : out_(file) {
  if (!out_) throw Error(ErrorCode::other, file + ": cannot be written");
}

double EventLog::now_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void EventLog::write(const char* event, const Json& fields) {
  if (!open()) return;
  Json line{{"t_s", std::round(now_s() * 1e4) / 1e4}, {"event", event}};
  line.update(fields);
  out_ << line.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;  // whole after a crash too
}

double residentMemory_mib() {
  std::ifstream statm("/proc/self/statm");
  long long total_pages = 0, resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

}  // namespace emscape::view
