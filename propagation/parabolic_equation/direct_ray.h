/// The antenna's pattern along the direct ray, for marches whose source has its elevation cut.
///
/// Losses of all models are relative to the direct ray's field, to which the antenna's pattern is applied
/// later, for any azimuth of the beam. So the march's field is divided by the cut at the direct ray's angle;
/// only the azimuth pattern remains.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/inputs.h"

namespace emscape::propagation {

/// Plain data.
struct DirectRayPattern {
  static constexpr int kEntries = 257;  ///< odd: 0 degrees is one
  /// Min level (dB): in a null of the pattern the ratio of the two fields is unbounded.
  static constexpr float kLowest_db = -120;

  bool is_weighed = false;  ///< false: the source is isotropic
  float max_angle_rad = 0;  ///< of the entries, up and down
  float db[kEntries] = {};

  EMSCAPE_HD float angle_rad(int entry) const {
    return max_angle_rad * (2 * static_cast<float>(entry) / (kEntries - 1) - 1);
  }
  /// Level (dB, up to 0) at an angle above the horizontal, clamped to the largest angle.
  EMSCAPE_HD float pattern_db(float elevation_rad) const {
    const float at = (elevation_rad / max_angle_rad + 1) * ((kEntries - 1) / 2);
    if (!(at > 0)) return db[0];
    if (at >= kEntries - 1) return db[kEntries - 1];
    const int below = static_cast<int>(at);
    return db[below] + (at - static_cast<float>(below)) * (db[below + 1] - db[below]);
  }
};

/// @param max_angle_rad  up to which the equation is solved, > 0
inline DirectRayPattern directRayPattern(const ElevationPattern& pattern, double max_angle_rad) {
  DirectRayPattern levels;
  levels.is_weighed = static_cast<bool>(pattern);
  levels.max_angle_rad = static_cast<float>(max_angle_rad);
  if (!pattern) return levels;
  for (int i = 0; i < DirectRayPattern::kEntries; ++i) {
    const double amplitude = std::fabs(pattern(static_cast<double>(levels.angle_rad(i))));
    const auto level_db = static_cast<float>(20 * std::log10(amplitude));
    levels.db[i] = level_db > DirectRayPattern::kLowest_db ? level_db : DirectRayPattern::kLowest_db;
  }
  return levels;
}

}  // namespace emscape::propagation
