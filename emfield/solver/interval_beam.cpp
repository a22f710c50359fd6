#include "emfield/solver/interval_beam.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "emscape/base/units.h"
#include "scenario/scan/swept_antenna.h"

namespace emscape::emfield {
namespace {

using scenario::BeamPose;
using scenario::Emitter;
using scenario::EmitterState;
using scenario::IntervalKind;
using scenario::ScanKind;
using scenario::ScanSweep;
using scenario::SweptArc;
using scenario::SweptPattern;
using scenario::TimeInterval;

/// Turns the sweep into a frame in which it does not depend on the time, if there is one: the middle of a
/// partial turn is forward.
/// @return the azimuth of that frame's forward
double turnIntoFrame(ScanSweep& sweep, double frame_deg) {
  if (sweep.arcs.size() == 1 && !sweep.arcs.front().isRound()) {
    SweptArc& arc = sweep.arcs.front();
    const double middle_deg = arc.first_deg + arc.width_deg / 2;
    arc.first_deg = -arc.width_deg / 2;
    return middle_deg - frame_deg;
  }
  const bool is_even = std::all_of(sweep.arcs.begin(), sweep.arcs.end(),
                                   [](const SweptArc& arc) { return arc.isWholeTurns(); });
  for (SweptArc& arc : sweep.arcs) arc.first_deg = is_even ? 0 : arc.first_deg - frame_deg;
  return 0;
}

}  // namespace

BeamPose sweepFrame(const Emitter& emitter, const EmitterState& state) {
  const bool turns_onto_dwells = emitter.scan.kind == ScanKind::dwell_list && !scenario::isSteered(emitter);
  return turns_onto_dwells
             ? scenario::aimed(state.mount, emitter.scan.azimuth_deg, emitter.scan.elevation_deg)
             : state.mount;
}

IntervalBeam intervalBeam(const scenario::Scenario& scenario, const Emitter& emitter,
                          const EmitterState& state, double t_s, bool needs_pattern,
                          const IntervalBeam* before) {
  const scenario::IntervalSpec& interval = scenario.output.interval;
  const scenario::ScanSpec& scan = emitter.scan;
  const double duration_s = scenario::intervalDuration_s(interval, scan, scenario.clock);
  IntervalBeam beam;
  beam.of_antenna = emitter.antenna;
  beam.of_kind = interval.kind;
  beam.of_sweep = scenario::sweepOf(emitter, t_s, duration_s);
  beam.antenna = emitter.antenna;
  ScanSweep& sweep = beam.of_sweep;
  if (stays(sweep)) {
    beam.looks = intervalLooks(scenario, emitter, t_s, sweep, 0);
    beam.pose = state.beam;
    beam.look_frame = sweepFrame(emitter, state);
    if (interval.kind == IntervalKind::mean) {
      beam.power_share = 0;
      for (const SweptArc& arc : sweep.arcs) beam.power_share += arc.share;
    }
    return beam;
  }
  const bool sweeps = scan.kind == ScanKind::sector || scan.kind == ScanKind::raster;
  const bool is_max_hold = interval.kind == IntervalKind::max_hold;
  if (is_max_hold && scan.kind != ScanKind::dwell_list) joinArcs(sweep.arcs);
  const double frame_deg = turnIntoFrame(sweep, sweeps ? scan.azimuth_deg : 0);
  beam.pose = scenario::aimed(sweepFrame(emitter, state), frame_deg, 0);
  beam.look_frame = beam.pose;
  beam.looks = intervalLooks(scenario, emitter, t_s, sweep, frame_deg + (sweeps ? scan.azimuth_deg : 0));
  if (!needs_pattern) return beam;
  for (SweptArc& arc : sweep.arcs) {
    if (is_max_hold && arc.isRound())
      arc.first_deg = 0;  // the largest values are the same wherever it begins
  }

  const bool is_known = before != nullptr && before->antenna != before->of_antenna &&
                        before->of_antenna == beam.of_antenna && before->of_kind == beam.of_kind &&
                        before->of_sweep == sweep;
  beam.antenna = is_known
                     ? before->antenna
                     : scenario::sweptAntenna(
                           *emitter.antenna, sweep,
                           interval.kind == IntervalKind::mean ? SweptPattern::mean : SweptPattern::largest);
  return beam;
}

Emitter whilePresent(const scenario::Snapshot& snapshot, const Emitter& emitter) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const double duration_s =
      scenario::intervalDuration_s(scenario.output.interval, emitter.scan, scenario.clock);
  Emitter present = emitter;
  std::vector<TimeInterval> times = scenario::activeTimes(snapshot, emitter, duration_s);
  if (scenario.platforms[static_cast<std::size_t>(emitter.platform)].moves() && !times.empty())
    present.active_s = std::move(times);
  return present;
}

std::vector<JammedLooks> looksByJammers(const scenario::Snapshot& snapshot, int radar,
                                        const EmitterState& state, const IntervalBeam& whole,
                                        const std::vector<JammerPath>& jammers) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const double t_s = snapshot.time_s;
  const Emitter& emitter = scenario.emitters[static_cast<std::size_t>(radar)];
  const double duration_s =
      scenario::intervalDuration_s(scenario.output.interval, emitter.scan, scenario.clock);
  const auto timesOf = [&](const Emitter& of) { return scenario::activeTimes(snapshot, of, duration_s); };
  const std::vector<TimeInterval> active = timesOf(emitter);
  std::vector<std::vector<TimeInterval>> of_jammers;
  for (const JammerPath& jammer : jammers)
    of_jammers.push_back(timesOf(scenario.emitters[static_cast<std::size_t>(jammer.jammer)]));

  std::vector<double> edges_s;
  const auto addEdges = [&edges_s](const std::vector<TimeInterval>& times) {
    for (const TimeInterval& time : times) edges_s.insert(edges_s.end(), {time.begin_s, time.end_s});
  };
  addEdges(active);
  for (const std::vector<TimeInterval>& times : of_jammers) addEdges(times);
  std::sort(edges_s.begin(), edges_s.end());
  const auto holds = [](const std::vector<TimeInterval>& times, double at_s) {
    const auto after =
        std::upper_bound(times.begin(), times.end(), at_s,
                         [](double value_s, const TimeInterval& time) { return value_s < time.begin_s; });
    return after != times.begin() && at_s < std::prev(after)->end_s;
  };
  std::map<std::vector<std::size_t>, std::vector<TimeInterval>> times_by_jammers;
  double active_s = 0;
  for (std::size_t n = 0; n + 1 < edges_s.size(); ++n) {
    const TimeInterval part{edges_s[n], edges_s[n + 1]};
    const double middle_s = (part.begin_s + part.end_s) / 2;
    if (!(part.begin_s < part.end_s) || !holds(active, middle_s)) continue;
    std::vector<std::size_t> radiating;
    for (std::size_t j = 0; j < of_jammers.size(); ++j) {
      if (holds(of_jammers[j], middle_s)) radiating.push_back(j);
    }
    times_by_jammers[radiating].push_back(part);
    active_s += part.end_s - part.begin_s;
  }
  const auto pathsOf = [&jammers](const std::vector<std::size_t>& radiating) {
    std::vector<JammerPath> paths;
    for (const std::size_t j : radiating) paths.push_back(jammers[j]);
    return paths;
  };
  if (times_by_jammers.empty()) return {{jammers, whole}};
  if (times_by_jammers.size() == 1) return {{pathsOf(times_by_jammers.begin()->first), whole}};

  std::vector<JammedLooks> all;
  const bool counts_cycles = emitter.scan.kind == ScanKind::dwell_list || stays(whole.of_sweep);
  const bool passes_everywhere = emitter.scan.kind == ScanKind::rotate && whole.looks.everywhere >= 1;
  const bool is_cumulative = scenario.output.interval.kind == IntervalKind::cumulative;
  const ScanSweep sweep = scenario::sweepOf(whilePresent(snapshot, emitter), t_s, duration_s);
  for (const auto& [radiating, times] : times_by_jammers) {
    Emitter part = emitter;
    part.active_s = times;
    double part_s = 0;
    for (const TimeInterval& time : times) part_s += time.end_s - time.begin_s;
    JammedLooks looks;
    const auto share = static_cast<float>(part_s / active_s);
    if (is_cumulative && !counts_cycles) {
      looks.beam = whole;
      looks.beam.looks = looksInPart(scenario, part, t_s, sweep, whole.looks, share);
    } else {
      looks.beam = intervalBeam(scenario, part, state, t_s, false, nullptr);
      // Looks that are not passes at known times are shared out by time.
      looks.beam.looks.least = passes_everywhere ? 0.0f : share;
      if (counts_cycles) looks.beam.looks.everywhere = whole.looks.everywhere * share;
    }
    looks.jammers = pathsOf(radiating);
    all.push_back(std::move(looks));
  }
  return all;
}

void lookInInterval(const IntervalBeam& beam, RadarTask& task, EmitterState& state) {
  task.looks.everywhere = beam.looks.everywhere;
  task.looks.least = beam.looks.least;
  if (task.look.kind != LookKind::turned) return;
  state.mount = beam.look_frame;
  if (beam.looks.half_width_deg >= kTurn_deg / 2) return;
  task.look.cos_azimuth = static_cast<float>(std::cos(degToRad(beam.looks.half_width_deg)));
  task.look.sin_azimuth = static_cast<float>(std::sin(degToRad(beam.looks.half_width_deg)));
}

}  // namespace emscape::emfield
