#include "scenario/scan/scan_sweep.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace emscape::scenario {
namespace {

auto membersOf(const SweptArc& arc) {
  const auto& [first_deg, width_deg, elevation_deg, share, times] = arc;
  return std::tie(first_deg, width_deg, elevation_deg, share, times);
}
auto membersOf(const SweptDwell& dwell) {
  const auto& [azimuth_deg, elevation_deg, share] = dwell;
  return std::tie(azimuth_deg, elevation_deg, share);
}
template <class T>
bool areSame(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& x, const T& y) { return membersOf(x) == membersOf(y); });
}

/// Ends of intervals, sweeps and dwells are sums of decimal numbers: parts of [begin, end) that are not
/// longer than this (s) come from their rounding.
double rounding_s(double begin_s, double end_s, double cycle_s = 0) {
  return std::min(1e-9 * cycle_s + 2e-15 * std::max(std::abs(begin_s), std::abs(end_s)),
                  (end_s - begin_s) / 4);
}

/// Adds the motion of a beam in a part of an interval.
class SweepBuilder {
 public:
  SweepBuilder(const Emitter& emitter, double interval_s, ScanSweep& sweep)
      : scan_(emitter.scan),
        steers_(emitter.antenna && emitter.antenna->is_array),
        interval_s_(interval_s),
        sweep_(sweep) {}

  void add(double begin_s, double duration_s) {
    const double cycle_s = scanCycle_s(scan_);
    if (cycle_s == 0) {
      const BeamDirection beam = beamAt(scan_, begin_s);
      sweep_.arcs.push_back({beam.azimuth_deg, 0, beam.elevation_deg, duration_s / interval_s_, 1});
    } else if (scan_.kind == ScanKind::rotate) {
      const double width_deg = 6 * std::abs(scan_.rate_rpm) * duration_s;
      const double first_deg = beamAt(scan_, begin_s).azimuth_deg - (scan_.rate_rpm < 0 ? width_deg : 0);
      addArc({first_deg, width_deg, scan_.elevation_deg, duration_s / interval_s_, 1});
    } else {
      const double cycles = std::floor(duration_s / cycle_s + 1e-9);
      if (cycles >= 1) addPositions(begin_s, begin_s + cycle_s, cycles);
      const double rest_s = duration_s - cycles * cycle_s;
      if (rest_s > rounding_s(begin_s, begin_s + duration_s, cycle_s))
        addPositions(begin_s + cycles * cycle_s, begin_s + duration_s, 1);
    }
  }

 private:
  void addPositions(double begin_s, double end_s, double times) {
    return scan_.kind == ScanKind::dwell_list ? addDwells(begin_s, end_s, times)
                                              : addSweeps(begin_s, end_s, times);
  }
  void addSweeps(double begin_s, double end_s, double times) {
    const double sweep_s = scan_.width_deg / scan_.rate_deg_s;
    const double shortest_s = rounding_s(begin_s, end_s, sweep_s);
    for (double n = std::floor(begin_s / sweep_s); n * sweep_s < end_s; ++n) {
      const double from_s = std::max(begin_s, n * sweep_s), to_s = std::min(end_s, (n + 1) * sweep_s);
      if (!(to_s - from_s > shortest_s)) continue;
      const BeamDirection middle = beamAt(scan_, (from_s + to_s) / 2);
      const double width_deg = (to_s - from_s) * scan_.rate_deg_s;
      addArc({middle.azimuth_deg - width_deg / 2, width_deg, middle.elevation_deg,
              times * (to_s - from_s) / interval_s_, times});
    }
  }
  /// Equal arcs, passed in either direction, are one, with the sum of their shares and passes.
  void addArc(const SweptArc& arc) {
    constexpr double kSame_deg = 1e-9;
    for (SweptArc& known : sweep_.arcs) {
      if (std::abs(known.first_deg - arc.first_deg) > kSame_deg ||
          std::abs(known.width_deg - arc.width_deg) > kSame_deg || known.elevation_deg != arc.elevation_deg)
        continue;
      known.share += arc.share;
      known.times += arc.times;
      return;
    }
    sweep_.arcs.push_back(arc);
  }
  void addDwells(double begin_s, double end_s, double times) {
    const double shortest_s = rounding_s(begin_s, end_s, scanCycle_s(scan_));
    double at_s = begin_s;
    double next_s = std::floor(begin_s / scanCycle_s(scan_)) * scanCycle_s(scan_);
    for (std::size_t i = 0; end_s - at_s > shortest_s; i = (i + 1) % scan_.dwells.size()) {
      const Dwell& dwell = scan_.dwells[i];
      next_s += dwell.duration_s;
      if (!(next_s - at_s > shortest_s)) continue;
      const double to_s = std::min(next_s, end_s), share = times * (to_s - at_s) / interval_s_;
      if (steers_) {
        sweep_.dwells.push_back({dwell.azimuth_deg, dwell.elevation_deg, share});
      } else {
        sweep_.arcs.push_back({dwell.azimuth_deg, 0, dwell.elevation_deg, share, times});
      }
      at_s = to_s;
    }
  }

  const ScanSpec& scan_;
  bool steers_;
  double interval_s_;
  ScanSweep& sweep_;
};

void addLastPasses(const ScanSpec& scan, double begin_s, double end_s, std::vector<TimedPass>& passes) {
  const double cycle_s = scanCycle_s(scan);
  const BeamDirection first = beamAt(scan, begin_s);
  if (cycle_s == 0) {
    passes.push_back({begin_s, end_s, first.azimuth_deg, first.azimuth_deg});
    return;
  }
  const double from_s = std::max(begin_s, end_s - cycle_s);
  if (scan.kind == ScanKind::rotate) {
    const double from_deg = beamAt(scan, from_s).azimuth_deg;
    passes.push_back({from_s, end_s, from_deg, from_deg + 6 * scan.rate_rpm * (end_s - from_s)});
    return;
  }
  const double sweep_s = scan.width_deg / scan.rate_deg_s, shortest_s = rounding_s(from_s, end_s, sweep_s);
  for (double n = std::floor(from_s / sweep_s); n * sweep_s < end_s; ++n) {
    const double at_s = std::max(from_s, n * sweep_s), to_s = std::min(end_s, (n + 1) * sweep_s);
    if (!(to_s - at_s > shortest_s)) continue;
    const double middle_deg = beamAt(scan, (at_s + to_s) / 2).azimuth_deg;
    const double half_deg = (std::fmod(n, 2) == 0 ? 0.5 : -0.5) * (to_s - at_s) * scan.rate_deg_s;
    passes.push_back({at_s, to_s, middle_deg - half_deg, middle_deg + half_deg});
  }
}

/// Calls visit(from_s, to_s, span_s) for each time in [begin, begin + duration) at which an emitter is
/// active, in their order. Times that overlap or touch are one. The span of the whole interval is its
/// duration, without rounding; ends that differ from the interval's by rounding are the interval's.
template <class Visit>
void visitActive(const Emitter& emitter, double begin_s, double duration_s, const Visit& visit) {
  const double end_s = begin_s + duration_s;
  if (!emitter.enabled) return;
  if (emitter.active_s.empty()) return visit(begin_s, end_s, duration_s);
  const double shortest_s = rounding_s(begin_s, end_s);
  std::vector<TimeInterval> parts;
  for (const TimeInterval& active : emitter.active_s) {
    const double from_s = active.begin_s <= begin_s + shortest_s ? begin_s : active.begin_s;
    const double to_s = active.end_s >= end_s - shortest_s ? end_s : active.end_s;
    if (to_s - from_s > shortest_s) parts.push_back({from_s, to_s});
  }
  std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.begin_s < b.begin_s; });
  for (std::size_t i = 0; i < parts.size();) {
    TimeInterval joined = parts[i++];
    for (; i < parts.size() && parts[i].begin_s <= joined.end_s; ++i)
      joined.end_s = std::max(joined.end_s, parts[i].end_s);
    const bool is_whole = joined.begin_s == begin_s && joined.end_s == end_s;
    visit(joined.begin_s, joined.end_s, is_whole ? duration_s : joined.end_s - joined.begin_s);
  }
}

/// Times in [begin, end) at which a platform is present, ascending, apart.
std::vector<TimeInterval> presentTimes(const Platform& platform, const Clock& clock, double begin_s,
                                       double end_s) {
  std::vector<TimeInterval> present;
  const auto add = [&](double from_s, double to_s) {
    from_s = std::max(from_s, begin_s);
    to_s = std::min(to_s, end_s);
    if (from_s < to_s) present.push_back({from_s, to_s});
  };
  if (!platform.moves()) {
    if (platform.isPresentAt(begin_s)) add(begin_s, end_s);
    return present;
  }
  const bool holds = platform.outside_track == OutsideTrack::hold;
  const std::vector<TrackPoint>& track = platform.track;
  double from_s = holds ? begin_s : track.front().t_s;
  for (std::size_t n = 0; n + 1 < track.size(); ++n) {
    if (!track[n].gap_after) continue;
    add(from_s, track[n].t_s);
    from_s = track[n + 1].t_s;
  }
  add(from_s, holds || track.back().t_s >= clock.duration_s ? end_s : track.back().t_s);
  return present;
}

}  // namespace

bool operator==(const ScanSweep& a, const ScanSweep& b) {
  return areSame(a.arcs, b.arcs) && areSame(a.dwells, b.dwells);
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
    case ScanKind::victim:
      break;
  }
  return 0;
}

double activeTime_s(const Emitter& emitter, double begin_s, double duration_s) {
  double active_s = 0;
  visitActive(emitter, begin_s, duration_s, [&](double, double, double span_s) { active_s += span_s; });
  return active_s;
}

std::vector<TimeInterval> activeTimes(const Emitter& emitter, double begin_s, double duration_s) {
  std::vector<TimeInterval> times;
  visitActive(emitter, begin_s, duration_s, [&](double from_s, double to_s, double) {
    times.push_back({from_s, to_s});
  });
  return times;
}

std::vector<TimeInterval> activeTimes(const Scenario& scenario, const Emitter& emitter, double begin_s,
                                      double duration_s) {
  const std::vector<TimeInterval> present =
      presentTimes(scenario.platforms[static_cast<std::size_t>(emitter.platform)], scenario.clock, begin_s,
                   begin_s + duration_s);
  std::vector<TimeInterval> times;
  for (const TimeInterval& active : activeTimes(emitter, begin_s, duration_s)) {
    for (const TimeInterval& here : present) {
      const TimeInterval both{std::max(active.begin_s, here.begin_s), std::min(active.end_s, here.end_s)};
      if (both.begin_s < both.end_s) times.push_back(both);
    }
  }
  return times;
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
  SweepBuilder builder(emitter, duration_s, sweep);
  visitActive(emitter, begin_s, duration_s,
              [&](double from_s, double, double span_s) { builder.add(from_s, span_s); });
  return sweep;
}

std::vector<TimedPass> lastPassesOf(const Emitter& emitter, double begin_s, double duration_s) {
  std::vector<TimedPass> passes;
  visitActive(emitter, begin_s, duration_s,
              [&](double from_s, double to_s, double) { addLastPasses(emitter.scan, from_s, to_s, passes); });
  return passes;
}

bool isActiveAt(const Emitter& emitter, double t_s) {
  if (!emitter.enabled || emitter.active_s.empty()) return emitter.enabled;
  return std::any_of(emitter.active_s.begin(), emitter.active_s.end(), [t_s](const TimeInterval& interval) {
    return t_s >= interval.begin_s && t_s < interval.end_s;
  });
}

}  // namespace emscape::scenario
