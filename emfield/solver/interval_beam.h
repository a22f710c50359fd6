/// An emitter's beam over the interval of a volume: a pattern and a pose that replace those of an instant,
/// and a radar's looks.
#pragma once

#include <vector>

#include "emfield/channels/radar_share.h"
#include "emfield/combine/radar_product.h"
#include "emfield/solver/interval_looks.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::emfield {

struct IntervalBeam {
  scenario::AntennaPtr
      antenna;  ///< its pattern is that of the interval; the emitter's own antenna if not needed
  scenario::BeamPose pose;
  double power_share =
      1;  ///< factor of the emitter's power, for the mean of an emitter that is not always active
  scenario::BeamPose look_frame;  ///< of a radar's looks at targets; replaces EmitterState::mount
  IntervalLooks looks;            ///< in look_frame

  /// Inputs from which the antenna was made.
  scenario::AntennaPtr of_antenna;
  scenario::IntervalKind of_kind = scenario::IntervalKind::instant;
  scenario::ScanSweep of_sweep;
};

/// @param interval  not of kind instant
/// @param state     active in the interval that begins at t_s
/// @param needs_pattern  false: only looks are needed
/// @param before    its beam at an earlier time, whose antenna is reused if equal; may be null
IntervalBeam intervalBeam(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                          const scenario::EmitterState& state, double t_s, bool needs_pattern,
                          const IntervalBeam* before);

/// An emitter that is active only while its platform is present in the interval that begins with a snapshot;
/// as it is if it is not active in the interval at all.
scenario::Emitter whilePresent(const scenario::Snapshot& snapshot, const scenario::Emitter& emitter);

/// The looks of a radar in the times of its interval in which the same jammers radiate.
struct JammedLooks {
  std::vector<JammerPath> jammers;
  IntervalBeam beam;
};

/// The looks of a radar in the interval that begins with a snapshot by the jammers that radiate at their
/// times; one element if these do not change while the radar is active.
/// @param whole    the radar's looks in the interval
/// @param jammers  that radiate at some time of the interval
std::vector<JammedLooks> looksByJammers(const scenario::Snapshot& snapshot, int radar,
                                        const scenario::EmitterState& state, const IntervalBeam& whole,
                                        const std::vector<JammerPath>& jammers);

/// The frame about whose up axis the arcs of a sweep turn, or in which its dwells are steered.
scenario::BeamPose sweepFrame(const scenario::Emitter& emitter, const scenario::EmitterState& state);

/// Replaces a radar's look at targets by its looks in the interval.
void lookInInterval(const IntervalBeam& beam, RadarTask& task, scenario::EmitterState& state);

}  // namespace emscape::emfield
