/// A radar's looks in the interval of a volume: their directions, their numbers and the age of the last one.
#pragma once

#include <vector>

#include "emfield/combine/radar_product.h"
#include "emscape/scenario/model/scenario.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::emfield {

constexpr double kTurn_deg = 360;

/// In a frame about whose up axis the beam turns.
struct IntervalLooks {
  double half_width_deg = 180;  ///< azimuths to both sides of the frame's forward that the beam passes
  float everywhere = 1;         ///< LookCount::everywhere
  float least = 1;              ///< LookCount::least
  double forward_deg = 0;       ///< azimuth of the frame's forward
  /// directions: if half_width_deg does not describe those that the beam passes; passes: of the kind
  /// cumulative, of scans with passes (scenario::lastPassesOf).
  IntervalArcs arcs;
};

/// @param scenario     with an interval that is not of kind instant, and begins at t_s
/// @param sweep        of the emitter in the interval, its azimuths relative to the frame's forward
/// @param forward_deg  azimuth of the frame's forward
IntervalLooks intervalLooks(const scenario::Scenario& scenario, const scenario::Emitter& emitter, double t_s,
                            const scenario::ScanSweep& sweep, double forward_deg);

/// The looks in a part of the interval, in the frame and towards the directions of those in all of it. Looks
/// at what the scan does not pass in the whole interval are shared out by time.
/// @param part   the emitter, active in this part of the interval alone
/// @param sweep  of the emitter in all of the interval: scenario::sweepOf()
/// @param share  of this part in the active time
IntervalLooks looksInPart(const scenario::Scenario& scenario, const scenario::Emitter& part, double t_s,
                          const scenario::ScanSweep& sweep, const IntervalLooks& whole, float share);

/// True if a beam has the same direction all the time.
bool stays(const scenario::ScanSweep& sweep);

/// Joins the azimuths that a beam passes, so that each occurs once. The largest values depend only on these,
/// so that intervals of at least one sweep there and back have the same pattern whenever they begin.
void joinArcs(std::vector<scenario::SweptArc>& arcs);

}  // namespace emscape::emfield
