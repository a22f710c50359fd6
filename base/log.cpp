#include "emscape/base/log.h"

#include <memory>
#include <mutex>
#include <utility>

namespace emscape {
namespace {

std::mutex sink_mutex;
std::shared_ptr<const LogSink> current_sink;  // never an empty function

void log(LogLevel level, const std::string& message) {
  std::shared_ptr<const LogSink> sink;
  {
    const std::lock_guard<std::mutex> lock(sink_mutex);
    sink = current_sink;
  }
  // Without the lock: a sink may log, or wait for a thread that logs.
  if (sink) (*sink)(level, message);
}

}  // namespace

void setLogSink(LogSink sink) {
  auto next = sink ? std::make_shared<const LogSink>(std::move(sink)) : nullptr;
  const std::lock_guard<std::mutex> lock(sink_mutex);
  current_sink.swap(next);  // the former sink is destroyed after the lock is released
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
