/// Where a beam is during an interval, and for which part of it.
#pragma once

#include <cmath>
#include <vector>

#include "emscape/scenario/clock.h"
#include "emscape/scenario/emitter.h"
#include "emscape/scenario/interval.h"

namespace emscape::scenario {

/// Azimuths that a beam passes at a constant rate and at one elevation. Angles are those of BeamDirection.
struct SweptArc {
  double first_deg = 0;  ///< the least azimuth
  double width_deg = 0;  ///< >= 0; above 360: more than a turn; 0: the beam stays
  double elevation_deg = 0;
  double share = 0;  ///< of the interval, 0..1
  double times = 1;  ///< how often it is passed

  /// A turn or more.
  bool isRound() const { return width_deg >= 360; }
  /// Turns without a rest: every azimuth is passed equally often.
  bool isWholeTurns() const {
    return isRound() && std::abs(std::remainder(width_deg, 360)) < 1e-6 * width_deg;
  }
};

/// One position of a steered beam.
struct SweptDwell {
  double azimuth_deg = 0, elevation_deg = 0;
  double share = 0;  ///< of the interval, 0..1
};

/// Shares add up to the part of the interval in which the emitter is active.
struct ScanSweep {
  std::vector<SweptArc> arcs;      ///< of an antenna that turns; each once
  std::vector<SweptDwell> dwells;  ///< of an array that is steered

  bool empty() const { return arcs.empty() && dwells.empty(); }
};
bool operator==(const ScanSweep& a, const ScanSweep& b);

/// Duration (s) of one turn, one sweep there and back, one raster or one cycle of dwells; 0: the beam stays.
double scanCycle_s(const ScanSpec& scan);

/// Duration (s) of an emitter's interval; a beam that stays has no turns: their number in steps of the clock.
double intervalDuration_s(const IntervalSpec& interval, const ScanSpec& scan, const Clock& clock);

/// The sweep of an emitter during [begin, begin + duration), in the times at which it is active; empty: it is
/// not. For the same part of a turn or cycle it is the same to the last bit but for `first_deg` of turns.
/// @param duration_s  > 0
ScanSweep sweepOf(const Emitter& emitter, double begin_s, double duration_s);

/// Azimuths that a beam passes once, at a constant rate.
struct TimedPass {
  double begin_s = 0, end_s = 0;      ///< since the epoch
  double begin_deg = 0, end_deg = 0;  ///< azimuths as of BeamDirection, at most a turn apart
};

/// The last passes of a beam that is fixed, rotates or sweeps a sector in [begin, begin + duration): of each
/// time at which the emitter is active those of its last turn or sweep there and back. A beam that stays
/// has passes of one azimuth.
std::vector<TimedPass> lastPassesOf(const Emitter& emitter, double begin_s, double duration_s);

}  // namespace emscape::scenario
