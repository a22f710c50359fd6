/// Closed forms of jamming in free space.
#pragma once

#include <cmath>

#include "emfield/radar/equation.h"

namespace emscape::emfield::testing {

/// Jammer-to-signal ratio (dB) at the radar's receiver.
/// @param range_m         to the target
/// @param jammer_range_m  to the jammer; for self-screening the target's
inline double jammerToSignalDb(const RadarLink& radar, double rcs_m2, double range_m,
                               const JammerLink& jammer, double jammer_range_m, double excess_db = 0,
                               double jammer_excess_db = 0) {
  return 10 * std::log10(jammingPower_w(radar, jammer, jammer_range_m, jammer_excess_db) /
                         echoPower_w(radar, rcs_m2, range_m, excess_db));
}

/// Burn-through range (m) in free space for a self-screening jammer: the range at which J/S reaches the value
/// at which the radar still detects. J/S grows with R^2.
/// @param max_jammer_to_signal_db  J/S at which the radar still detects
inline double selfScreeningBurnThrough_m(const RadarLink& radar, double rcs_m2, const JammerLink& jammer,
                                         double max_jammer_to_signal_db) {
  return std::pow(10.0, (max_jammer_to_signal_db - jammerToSignalDb(radar, rcs_m2, 1, jammer, 1)) / 20);
}

/// The same for a stand-off jammer at its own range: J/S grows with R^4.
inline double standOffBurnThrough_m(const RadarLink& radar, double rcs_m2, const JammerLink& jammer,
                                    double jammer_range_m, double max_jammer_to_signal_db) {
  return std::pow(
      10.0, (max_jammer_to_signal_db - jammerToSignalDb(radar, rcs_m2, 1, jammer, jammer_range_m)) / 40);
}

}  // namespace emscape::emfield::testing
