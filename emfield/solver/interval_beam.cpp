#include "emfield/solver/interval_beam.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "emscape/base/units.h"
#include "scenario/swept_antenna.h"

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

/// Joins the azimuths that a beam passes, so that each occurs once. The largest values depend only on these,
/// so that intervals of at least one sweep there and back have the same pattern whenever they begin.
void joinArcs(std::vector<SweptArc>& arcs) {
  if (arcs.size() < 2) return;
  constexpr double kPerDegree = 1e9, kRounding_deg = 1 / kPerDegree;
  const auto rounded = [](double angle_deg) { return std::round(angle_deg * kPerDegree) / kPerDegree; };
  std::sort(arcs.begin(), arcs.end(), [](const SweptArc& a, const SweptArc& b) {
    return std::tie(a.elevation_deg, a.first_deg) < std::tie(b.elevation_deg, b.first_deg);
  });
  std::vector<SweptArc> joined;
  for (const SweptArc& arc : arcs) {
    const double end_deg = arc.first_deg + arc.width_deg;
    const bool joins = !joined.empty() && joined.back().elevation_deg == arc.elevation_deg &&
                       arc.first_deg <= joined.back().first_deg + joined.back().width_deg + kRounding_deg;
    if (!joins) joined.push_back({rounded(arc.first_deg), 0, arc.elevation_deg, 1, 1});
    SweptArc& last = joined.back();
    last.width_deg = std::max(last.width_deg, rounded(end_deg - last.first_deg));
  }
  arcs = std::move(joined);
}

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

/// Number of looks of a sweep whose azimuths are in the look's frame.
/// @param bars  of a raster: each passes its own elevations
LookCount countLooks(const ScanSweep& sweep, double whole_deg, int bars) {
  LookCount looks;
  if (!sweep.dwells.empty()) return looks;
  looks.everywhere = 0;
  for (const SweptArc& arc : sweep.arcs) {
    const double whole = std::floor(arc.width_deg / whole_deg + 1e-9);
    looks.everywhere += static_cast<float>(arc.times * whole);
    const double rest_deg = arc.width_deg - whole * whole_deg;
    if (rest_deg <= 1e-6 * whole_deg || looks.arc_count == LookCount::kMaxArcs) continue;
    const double middle_rad = degToRad(arc.first_deg + rest_deg / 2);
    looks.cos_middle[looks.arc_count] = static_cast<float>(std::cos(middle_rad));
    looks.sin_middle[looks.arc_count] = static_cast<float>(std::sin(middle_rad));
    looks.cos_half[looks.arc_count++] = static_cast<float>(std::cos(degToRad(rest_deg / 2)));
  }
  looks.everywhere = std::floor(looks.everywhere / static_cast<float>(bars));
  return looks;
}

/// The last passes in a frame whose forward is at an azimuth, before an interval's end.
/// @param is_still  the beam does not move: it looks continuously in all possible directions
LastPasses lastPasses(std::vector<scenario::TimedPass> passes, double frame_deg, bool is_still,
                      double end_s) {
  std::sort(passes.begin(), passes.end(), [](const auto& a, const auto& b) { return a.end_s > b.end_s; });
  LastPasses last;
  for (const scenario::TimedPass& pass : passes) {
    if (last.arc_count == LastPasses::kMaxArcs) break;
    const int n = last.arc_count++;
    const double width_deg = pass.end_deg - pass.begin_deg;
    last.middle_rad[n] = static_cast<float>(
        degToRad(std::remainder((pass.begin_deg + pass.end_deg) / 2 - frame_deg, kTurn_deg)));
    last.half_width_rad[n] = static_cast<float>(is_still ? kPi : degToRad(std::abs(width_deg) / 2));
    last.age_s[n] = static_cast<float>(end_s - (is_still ? pass.end_s : (pass.begin_s + pass.end_s) / 2));
    if (width_deg != 0)
      last.age_s_rad[n] = static_cast<float>(-(pass.end_s - pass.begin_s) / degToRad(width_deg));
  }
  return last;
}

/// Number of cycles of the dwells in an interval; each cycle is one look in every direction.
float dwellLooks(const scenario::ScanSpec& scan, double duration_s) {
  return static_cast<float>(std::max(1.0, std::floor(duration_s / scenario::scanCycle_s(scan) + 1e-9)));
}

}  // namespace

bool stays(const ScanSweep& sweep) {
  return sweep.dwells.empty() && std::all_of(sweep.arcs.begin(), sweep.arcs.end(), [&](const SweptArc& arc) {
           return arc.width_deg == 0 && arc.first_deg == sweep.arcs.front().first_deg &&
                  arc.elevation_deg == sweep.arcs.front().elevation_deg;
         });
}

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
  const bool counts_passes = interval.kind == IntervalKind::cumulative && scan.kind != ScanKind::raster &&
                             scan.kind != ScanKind::dwell_list;
  const auto passesIn = [&](double frame_deg) {
    return lastPasses(scenario::lastPassesOf(emitter, t_s, duration_s), frame_deg, stays(sweep),
                      t_s + duration_s);
  };
  if (stays(sweep)) {
    if (counts_passes) beam.last_passes = passesIn(0);
    beam.pose = state.beam;
    beam.look_frame = state.mount;
    if (interval.kind == IntervalKind::mean) {
      beam.power_share = 0;
      for (const SweptArc& arc : sweep.arcs) beam.power_share += arc.share;
    }
    return beam;
  }
  const bool sweeps = scan.kind == ScanKind::sector || scan.kind == ScanKind::raster;
  const bool is_max_hold = interval.kind == IntervalKind::max_hold;
  if (is_max_hold && sweeps) joinArcs(sweep.arcs);
  const double frame_deg = turnIntoFrame(sweep, sweeps ? scan.azimuth_deg : 0);
  beam.pose = scenario::aimed(sweepFrame(emitter, state), frame_deg, 0);
  beam.look_frame = beam.pose;
  if (counts_passes) beam.last_passes = passesIn(frame_deg + (sweeps ? scan.azimuth_deg : 0));
  beam.looks =
      countLooks(sweep, sweeps ? scan.width_deg : kTurn_deg, scan.kind == ScanKind::raster ? scan.bars : 1);
  if (scan.kind == ScanKind::dwell_list) {
    beam.looks = {};
    beam.looks.everywhere = dwellLooks(scan, duration_s);
  } else if (std::none_of(sweep.arcs.begin(), sweep.arcs.end(),
                          [](const SweptArc& arc) { return arc.isRound(); })) {
    double lowest_deg = HUGE_VAL, highest_deg = -HUGE_VAL;
    for (const SweptArc& arc : sweep.arcs) {
      lowest_deg = std::min(lowest_deg, arc.first_deg);
      highest_deg = std::max(highest_deg, arc.first_deg + arc.width_deg);
    }
    const bool is_ahead = sweep.arcs.size() == 1 || sweeps;
    if (is_ahead && highest_deg - lowest_deg < kTurn_deg)
      beam.look_half_width_deg = std::max(-lowest_deg, highest_deg);
  }
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

void lookInInterval(const IntervalBeam& beam, RadarTask& task, EmitterState& state) {
  task.looks = beam.looks;
  task.last_passes = beam.last_passes;
  if (task.look.kind != LookKind::turned) return;
  state.mount = beam.look_frame;
  if (beam.look_half_width_deg >= kTurn_deg / 2) return;
  task.look.cos_azimuth = static_cast<float>(std::cos(degToRad(beam.look_half_width_deg)));
  task.look.sin_azimuth = static_cast<float>(std::sin(degToRad(beam.look_half_width_deg)));
}

}  // namespace emscape::emfield
