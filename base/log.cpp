#include "emscape/base/log.h"

#include <mutex>

namespace emscape {
namespace {

std::mutex sink_mutex;
LogSink current_sink;

void log(LogLevel level, const std::string& message) {
  std::lock_guard<std::mutex> lock(sink_mutex);
  if (current_sink) current_sink(level, message);
}

}  // namespace

void setLogSink(LogSink sink) {
  std::lock_guard<std::mutex> lock(sink_mutex);
  current_sink = std::move(sink);
}

void logDebug(const std::string& message) {
  log(LogLevel::debug, message);
}
void logInfo(const std::string& message) {
  log(LogLevel::info, message);
}
void logWarning(const std::string& message) {
  log(LogLevel::warning, message);
}

}  // namespace emscape
