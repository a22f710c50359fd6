/// The step nearest to a time. Internal to the module.
#pragma once

#include <algorithm>
#include <vector>

namespace emscape::playback {

/// Index of the nearest of ascending times, at least one; of two equally near, the earlier.
inline int nearestTime(const std::vector<double>& times_s, double time_s) {
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return 0;
  const auto index = static_cast<int>(after - times_s.begin());
  if (after == times_s.end()) return index - 1;
  return *after - time_s < time_s - *(after - 1) ? index : index - 1;
}

}  // namespace emscape::playback
