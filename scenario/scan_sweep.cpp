#include "scenario/scan_sweep.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace emscape::scenario {
namespace {

bool operator==(const SweptArc& a, const SweptArc& b) {
  return std::tie(a.first_deg, a.width_deg, a.elevation_deg, a.share) ==
         std::tie(b.first_deg, b.width_deg, b.elevation_deg, b.share);
}
bool operator==(const SweptDwell& a, const SweptDwell& b) {
  return std::tie(a.azimuth_deg, a.elevation_deg, a.share) ==
         std::tie(b.azimuth_deg, b.elevation_deg, b.share);
}

/// Sweeps of a sector or raster that begin before a time, in order; each covers the whole width.
/// @param weight  of the shares of the time
void addSweeps(const ScanSpec& scan, double begin_s, double end_s, double weight, ScanSweep& sweep) {
  const double sweep_s = scan.width_deg / scan.rate_deg_s;
  for (double n = std::floor(begin_s / sweep_s); n * sweep_s < end_s; ++n) {
    const double from_s = std::max(begin_s, n * sweep_s), to_s = std::min(end_s, (n + 1) * sweep_s);
    if (!(to_s > from_s)) continue;
    const BeamDirection middle = beamAt(scan, (from_s + to_s) / 2);
    const double width_deg = (to_s - from_s) * scan.rate_deg_s;
    sweep.arcs.push_back(
        {middle.azimuth_deg - width_deg / 2, width_deg, middle.elevation_deg, (to_s - from_s) * weight});
  }
}

void addDwells(const ScanSpec& scan, double begin_s, double end_s, double weight, ScanSweep& sweep) {
  double at_s = begin_s;
  double cycle_s = scanCycle_s(scan);
  if (!(cycle_s > 0)) return;
  double dwell_s = std::floor(begin_s / cycle_s) * cycle_s;  // where the next dwell begins
  for (std::size_t i = 0; at_s < end_s; i = (i + 1) % scan.dwells.size()) {
    const Dwell& dwell = scan.dwells[i];
    dwell_s += dwell.duration_s;
    if (dwell_s <= at_s) continue;
    const double to_s = std::min(dwell_s, end_s);
    sweep.dwells.push_back({dwell.azimuth_deg, dwell.elevation_deg, (to_s - at_s) * weight});
    at_s = to_s;
  }
}

/// The part of a sweep from begin to end. Whole cycles are gone through once.
void addPart(const ScanSpec& scan, double begin_s, double end_s, double weight, ScanSweep& sweep) {
  const double cycle_s = scanCycle_s(scan);
  if (scan.kind == ScanKind::rotate && scan.rate_rpm != 0) {
    const double width_deg = 6 * std::abs(scan.rate_rpm) * (end_s - begin_s);
    const double first_deg = beamAt(scan, begin_s).azimuth_deg - (scan.rate_rpm < 0 ? width_deg : 0);
    sweep.arcs.push_back({first_deg, width_deg, scan.elevation_deg, (end_s - begin_s) * weight});
    return;
  }
  if (cycle_s == 0) {
    const BeamDirection beam = beamAt(scan, begin_s);
    sweep.arcs.push_back({beam.azimuth_deg, 0, beam.elevation_deg, (end_s - begin_s) * weight});
    return;
  }
  const auto add = scan.kind == ScanKind::dwell_list ? addDwells : addSweeps;
  const double cycles = std::floor((end_s - begin_s) / cycle_s);
  const double rest_s = begin_s + cycles * cycle_s;
  if (cycles >= 1) add(scan, begin_s, begin_s + cycle_s, cycles * weight, sweep);
  if (rest_s < end_s) add(scan, rest_s, end_s, weight, sweep);
}

}  // namespace

const char* toString(IntervalKind kind) {
  static constexpr const char* kNames[] = {"instant", "max_hold", "mean", "cumulative"};
  return kNames[static_cast<int>(kind)];
}

bool operator==(const ScanSweep& a, const ScanSweep& b) {
  return std::equal(a.arcs.begin(), a.arcs.end(), b.arcs.begin(), b.arcs.end(),
                    [](const SweptArc& x, const SweptArc& y) { return x == y; }) &&
         std::equal(a.dwells.begin(), a.dwells.end(), b.dwells.begin(), b.dwells.end(),
                    [](const SweptDwell& x, const SweptDwell& y) { return x == y; });
}

double scanCycle_s(const ScanSpec& scan) {
  double cycle_s = 0;
  switch (scan.kind) {
    case ScanKind::rotate:
      return scan.rate_rpm == 0 ? 0 : 60 / std::abs(scan.rate_rpm);
    case ScanKind::sector:
      return 2 * scan.width_deg / scan.rate_deg_s;
    case ScanKind::raster:  // an odd number of bars returns on the other side
      return scan.bars * (scan.bars % 2 == 0 ? 1 : 2) * scan.width_deg / scan.rate_deg_s;
    case ScanKind::dwell_list:
      for (const Dwell& dwell : scan.dwells) cycle_s += dwell.duration_s;
      return cycle_s;
    case ScanKind::fixed:
    case ScanKind::track:
      break;
  }
  return 0;
}

double intervalDuration_s(const IntervalSpec& interval, const ScanSpec& scan, const Clock& clock) {
  if (interval.kind == IntervalKind::instant) return 0;
  if (interval.seconds) return *interval.seconds;
  if (!interval.turns) return clock.step_s;
  const double cycle_s = scanCycle_s(scan);
  return *interval.turns * (cycle_s > 0 ? cycle_s : clock.step_s);
}

ScanSweep sweepOf(const Emitter& emitter, double begin_s, double duration_s) {
  ScanSweep sweep;
  const double end_s = begin_s + duration_s;
  if (!(duration_s > 0)) return sweep;
  const auto add = [&](double from_s, double to_s) {
    from_s = std::max(from_s, begin_s), to_s = std::min(to_s, end_s);
    if (to_s > from_s) addPart(emitter.scan, from_s, to_s, 1 / duration_s, sweep);
  };
  if (emitter.active_s.empty()) add(begin_s, end_s);
  for (const TimeInterval& active : emitter.active_s) add(active.begin_s, active.end_s);
  return sweep;
}

}  // namespace emscape::scenario
