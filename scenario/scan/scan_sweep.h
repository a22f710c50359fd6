/// The directions of a beam during an interval, and their share of the time.
#pragma once

#include <cmath>
#include <vector>

#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/emitter.h"
#include "emscape/scenario/model/interval.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// Azimuths that a beam passes at a constant rate and at one elevation. Angles are those of BeamDirection.
struct SweptArc {
  double first_deg = 0;  ///< the smallest azimuth
  double width_deg = 0;  ///< >= 0; above 360: more than a turn; 0: the beam stays
  double elevation_deg = 0;
  double share = 0;  ///< of the interval, 0..1
  double times = 1;  ///< number of passes

  /// True for a full turn or more.
  bool isRound() const { return width_deg >= 360; }
  /// True for a whole number of turns: every azimuth is passed equally often.
  bool isWholeTurns() const {
    return isRound() && std::abs(std::remainder(width_deg, 360)) < 1e-6 * width_deg;
  }
};

/// One position of a steered beam.
struct SweptDwell {
  double azimuth_deg = 0, elevation_deg = 0;
  double share = 0;  ///< of the interval, 0..1
};

/// The sum of the shares is the part of the interval in which the emitter is active.
struct ScanSweep {
  /// Of an antenna that turns. Equal arcs of a rotating or sweeping beam are one, with the sum of their
  /// shares and passes; dwells are one arc each.
  std::vector<SweptArc> arcs;
  std::vector<SweptDwell> dwells;  ///< of an array that is steered

  bool empty() const { return arcs.empty() && dwells.empty(); }
};
bool operator==(const ScanSweep& a, const ScanSweep& b);

/// Duration (s) of one turn, one sweep there and back, one raster or one cycle of dwells; 0: the beam does
/// not move.
double scanCycle_s(const ScanSpec& scan);

/// True if an emitter is enabled and transmits at this time.
bool isActiveAt(const Emitter& emitter, double t_s);

/// Time (s) in [begin, begin + duration) at which an emitter is active. Times in several of Emitter::active_s
/// count once, here and below.
double activeTime_s(const Emitter& emitter, double begin_s, double duration_s);

/// Times in [begin, begin + duration) at which an emitter is active, ascending, apart.
std::vector<TimeInterval> activeTimes(const Emitter& emitter, double begin_s, double duration_s);

/// Times in [begin, begin + duration) at which an emitter is active and its platform present, ascending,
/// apart. A platform whose track reaches the end of the clock stays present after it. Ends that differ from
/// the interval's by rounding are the interval's.
std::vector<TimeInterval> activeTimes(const Scenario& scenario, const Emitter& emitter, double begin_s,
                                      double duration_s);

/// Duration (s) of an emitter's interval. For a beam that does not move, turns are counted in steps of the
/// clock.
double intervalDuration_s(const IntervalSpec& interval, const ScanSpec& scan, const Clock& clock);

/// The sweep of an emitter during [begin, begin + duration), at the times at which it is active; empty if it
/// is inactive. For the same part of a turn or cycle it is bit-identical except for `first_deg` of turns.
/// @param duration_s  > 0
ScanSweep sweepOf(const Emitter& emitter, double begin_s, double duration_s);

/// Azimuths that a beam passes once, at a constant rate.
struct TimedPass {
  double begin_s = 0, end_s = 0;      ///< since the epoch
  double begin_deg = 0, end_deg = 0;  ///< azimuths as of BeamDirection, at most a turn apart
};

/// The last passes of a beam that is fixed, rotates or sweeps a sector in [begin, begin + duration): for each
/// active time, those of its last turn or sweep there and back. A beam that does not move has passes of one
/// azimuth.
std::vector<TimedPass> lastPassesOf(const Emitter& emitter, double begin_s, double duration_s);

}  // namespace emscape::scenario
