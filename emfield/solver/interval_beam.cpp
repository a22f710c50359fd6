#include "emfield/solver/interval_beam.h"

#include <algorithm>
#include <cmath>

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

void lookInInterval(const IntervalBeam& beam, RadarTask& task, EmitterState& state) {
  task.looks.everywhere = beam.looks.everywhere;
  if (task.look.kind != LookKind::turned) return;
  state.mount = beam.look_frame;
  if (beam.looks.half_width_deg >= kTurn_deg / 2) return;
  task.look.cos_azimuth = static_cast<float>(std::cos(degToRad(beam.looks.half_width_deg)));
  task.look.sin_azimuth = static_cast<float>(std::sin(degToRad(beam.looks.half_width_deg)));
}

}  // namespace emscape::emfield
