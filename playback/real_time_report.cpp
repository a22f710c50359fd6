#include "emscape/playback/real_time_report.h"

#include <algorithm>

namespace emscape::playback {

int RealTimeReport::count(render::ControllerState state) const {
  return static_cast<int>(std::count_if(events.begin(), events.end(),
                                        [state](const auto& event) { return event.state == state; }));
}

int RealTimeReport::unequal() const {
  return static_cast<int>(std::count_if(events.begin(), events.end(), [](const auto& event) {
    return event.equals_full && !*event.equals_full;
  }));
}

}  // namespace emscape::playback
