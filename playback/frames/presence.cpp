#include "playback/frames/presence.h"

#include <algorithm>

namespace emscape::playback {

bool isPresentAt(const scenario::Scenario& scenario, const scenario::Emitter& emitter, double time_s) {
  if (emitter.platform < 0) return true;
  return scenario.platforms[static_cast<std::size_t>(emitter.platform)].isPresentAt(time_s);
}

double firstPresentTime_s(const scenario::Scenario& scenario, const std::vector<double>& times_s) {
  const auto firstWith = [&](const auto& items, const auto& isPresent) {
    return std::find_if(times_s.begin(), times_s.end(), [&](double time_s) {
      return std::any_of(items.begin(), items.end(),
                         [&](const auto& item) { return isPresent(item, time_s); });
    });
  };
  auto found = firstWith(scenario.emitters, [&](const scenario::Emitter& emitter, double time_s) {
    return isPresentAt(scenario, emitter, time_s);
  });
  if (found == times_s.end()) {
    found = firstWith(scenario.platforms, [](const scenario::Platform& platform, double time_s) {
      return platform.isPresentAt(time_s);
    });
  }
  return found == times_s.end() ? times_s.front() : *found;
}

}  // namespace emscape::playback
