/// Motion of an antenna's beam.
#pragma once

#include <array>
#include <vector>

#include "emscape/base/enum_names.h"

namespace emscape::scenario {

using emscape::toString;

/// fixed: the beam does not move. track: a radar whose antenna turns to its target in any direction; for
/// quantities without a target (power density, radar_look: scan) it points as if fixed. victim: the antenna
/// turns to a platform in any direction, along the straight line.
enum class ScanKind { fixed, rotate, sector, raster, dwell_list, track, victim };
constexpr auto namesOf(ScanKind) {
  return std::array{"fixed", "rotate", "sector", "raster", "dwell_list", "track", "victim"};
}

/// One position of an electronically steered beam, held for duration_s.
struct Dwell {
  double azimuth_deg = 0;    ///< off the mount's boresight, clockwise
  double elevation_deg = 0;  ///< off the mount's boresight, upwards
  double duration_s = 0;
};

/// Angles in degrees as in the file. The mount's boresight is the platform's heading (level platforms:
/// north-referenced), turned by azimuth_deg and elevation_deg.
struct ScanSpec {
  ScanKind kind = ScanKind::fixed;
  double azimuth_deg = 0;         ///< fixed, track: boresight; rotate: at t = 0; sector, raster: centre
  double elevation_deg = 0;       ///< boresight elevation, upwards; raster: centre of the bars
  double rate_rpm = 0;            ///< rotate: clockwise if positive
  double width_deg = 0;           ///< sector, raster: full width of the azimuth sweep
  double rate_deg_s = 0;          ///< sector, raster: azimuth speed
  double elevation_step_deg = 0;  ///< raster: between bars
  int bars = 1;                   ///< raster
  std::vector<Dwell> dwells;      ///< dwell_list, repeated
  int victim = -1;                ///< victim: index of the platform
};

/// Direction of a beam (deg), relative to the platform's axes if the antenna turns. If the beam is steered
/// (dwell_list), relative to the mount's boresight, which is turned by azimuth_deg and elevation_deg of the
/// scan.
struct BeamDirection {
  double azimuth_deg = 0;
  double elevation_deg = 0;
  /// True: steered electronically; the antenna does not turn (dwell_list).
  bool electronic = false;
};

/// The beam at t_s seconds since the epoch. A pure function: no error accumulates over time. rotate: azimuth
/// in 0..360. sector: back and forth, from the left end at t = 0. raster: the same sweeps, each one bar
/// higher than the previous one, then again from the lowest. dwell_list: durations and t count in whole
/// nanoseconds, so that a dwell ends exactly where the next begins.
BeamDirection beamAt(const ScanSpec& scan, double t_s);

}  // namespace emscape::scenario
