#include "playback/pictures/real_time_report.h"

#include <algorithm>

namespace emscape::playback {

void RealTimeTotals::add(const RealTimeEvent& event) {
  switch (event.state) {
    case render::ControllerState::busy:
      ++busy;
      late += event.late ? 1 : 0;
      ++frames_of[event.pattern];
      if (event.abort_latency_ms)
        max_abort_latency_ms = std::max(max_abort_latency_ms.value_or(0), *event.abort_latency_ms);
      break;
    case render::ControllerState::restore:
      ++(event.restored ? restores_done : restores_aborted);
      break;
    case render::ControllerState::idle:
      ++settled;
      compared += event.equals_full ? 1 : 0;
      equal += event.equals_full.value_or(false) ? 1 : 0;
      break;
  }
}

}  // namespace emscape::playback
