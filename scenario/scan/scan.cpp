#include "emscape/scenario/scan/scan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace emscape::scenario {

namespace {

/// value mod period, 0 <= result < period, exact as fmod is.
double positiveModulo(double value, double period) {
  const double rest = std::fmod(value, period);
  const double positive = rest < 0 ? rest + period : rest;
  return positive < period ? positive : 0;  // a tiny negative remainder rounds to the period
}

std::int64_t nanoseconds(double time_s) {
  return std::llround(time_s * 1e9);
}

/// Azimuth and bar of a beam that sweeps back and forth, one bar further with each sweep. A time at which a
/// sweep ends but for rounding belongs to the next.
BeamDirection sweepAt(const ScanSpec& scan, double t_s, int bars) {
  const double swept_deg = t_s * scan.rate_deg_s;
  const double there_and_back_deg = positiveModulo(swept_deg, 2 * scan.width_deg);
  const double from_left_deg = std::min(there_and_back_deg, 2 * scan.width_deg - there_and_back_deg);
  const double sweeps = swept_deg / scan.width_deg;
  const double bar = positiveModulo(std::floor(sweeps + 1e-9 + 1e-15 * std::abs(sweeps)), bars);
  return {scan.azimuth_deg - scan.width_deg / 2 + from_left_deg,
          scan.elevation_deg + (bar - (bars - 1) / 2.0) * scan.elevation_step_deg, false};
}

BeamDirection dwellAt(const ScanSpec& scan, double t_s) {
  std::int64_t cycle_ns = 0;
  for (const Dwell& dwell : scan.dwells) cycle_ns += nanoseconds(dwell.duration_s);
  if (cycle_ns <= 0) return {0, 0, true};
  std::int64_t rest_ns = nanoseconds(t_s) % cycle_ns;
  if (rest_ns < 0) rest_ns += cycle_ns;
  std::size_t i = 0;
  while (rest_ns >= nanoseconds(scan.dwells[i].duration_s))
    rest_ns -= nanoseconds(scan.dwells[i++].duration_s);
  return {scan.dwells[i].azimuth_deg, scan.dwells[i].elevation_deg, true};
}

}  // namespace

BeamDirection beamAt(const ScanSpec& scan, double t_s) {
  switch (scan.kind) {
    case ScanKind::rotate:
      // 6 degrees a second for each revolution a minute.
      return {positiveModulo(scan.azimuth_deg + 6 * std::fmod(t_s * scan.rate_rpm, 60.0), 360),
              scan.elevation_deg, false};
    case ScanKind::sector:
      return sweepAt(scan, t_s, 1);
    case ScanKind::raster:
      return sweepAt(scan, t_s, scan.bars);
    case ScanKind::dwell_list:
      return dwellAt(scan, t_s);
    case ScanKind::fixed:
    case ScanKind::track:
    case ScanKind::victim:
      break;
  }
  return {scan.azimuth_deg, scan.elevation_deg, false};
}

}  // namespace emscape::scenario
