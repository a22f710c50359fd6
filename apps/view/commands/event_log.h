/// Log of the window's events in JSON Lines format.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "apps/view/commands/command.h"
#include "base/files/appended_file.h"

namespace emscape::view {

/// One line per frame and per event, each with the time since the start. For use by one thread.
class EventLog {
 public:
  EventLog();
  /// @throws Error (other) if the file cannot be written; (usage) if it is no log
  explicit EventLog(const std::string& file);

  bool open() const { return out_.has_value(); }
  /// Seconds since the program started.
  double now_s() const;
  /// Writes {"t_s", "event", ...}; no effect if no file is open.
  void write(const char* event, const Json& fields = Json::object());

 private:
  std::chrono::steady_clock::time_point start_;
  std::optional<AppendedFile> out_;
};

/// Resident memory of this process (MiB).
double residentMemory_mib();
/// CPU time of this process (s).
double processorTime_s();

}  // namespace emscape::view
