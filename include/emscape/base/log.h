/// Messages of the libraries. A library never prints: the program sets a sink (none by default).
#pragma once

#include <functional>
#include <string>

namespace emscape {

enum class LogLevel { debug, info, warning };

/// Receives messages. Threads that log at the same time call it at the same time. It may itself log.
using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces the receiver of all messages; an empty sink silences them. Safe to call while others log: their
/// calls of the former sink may end after this function has returned; until then the sink is kept.
void setLogSink(LogSink sink);

void logDebug(const std::string& message);
void logInfo(const std::string& message);
void logWarning(const std::string& message);

}  // namespace emscape
