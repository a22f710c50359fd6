/// Progress reports and cancellation of long work.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace emscape {

/// Receives the step's name and the completed fraction, 0..1. May be called from any thread, one call at a
/// time.
using ProgressSink = std::function<void(const std::string& step, double fraction)>;

/// Set from another thread (or a signal) to abort long work at its next checkpoint.
using StopFlag = std::atomic<bool>;

}  // namespace emscape
