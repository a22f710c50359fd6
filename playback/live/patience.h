/// Patience of requests with fields of earlier requests.
#pragma once

#include <limits>

namespace emscape::playback {

/// A field is abandoned when a newer request is pending and it has been computed for this time (ms). In a
/// sequence of such requests every second field has more time, so that the picture follows.
struct Patience {
  static constexpr double kNone = 0;    ///< of single changes: edits, another quantity
  static constexpr double kShort = 60;  ///< of requests that may follow one another: drags, seeks
  static constexpr double kEndless = std::numeric_limits<double>::infinity();  ///< of playing
};

}  // namespace emscape::playback
