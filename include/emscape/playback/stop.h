/// Cancellation of long work.
#pragma once

#include <exception>

#include "emscape/base/progress.h"

namespace emscape::playback {

/// Thrown between two steps of the work after its StopFlag was set. Finished steps are kept.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

/// @param stop  may be null
/// @throws Stopped
inline void throwIfStopped(const StopFlag* stop) {
  if (stop != nullptr && *stop) throw Stopped();
}

}  // namespace emscape::playback
