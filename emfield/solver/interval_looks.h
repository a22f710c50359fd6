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
  /// directions: if half_width_deg does not describe those that the beam passes; passes: of the kind
  /// cumulative, of scans with passes (scenario::lastPassesOf).
  IntervalArcs arcs;
};

/// @param scenario     with an interval that is not of kind instant, and begins at t_s
/// @param sweep        of the emitter in the interval, its azimuths relative to the frame's forward
/// @param forward_deg  azimuth of the frame's forward
IntervalLooks intervalLooks(const scenario::Scenario& scenario, const scenario::Emitter& emitter, double t_s,
                            const scenario::ScanSweep& sweep, double forward_deg);

/// True if a beam has the same direction all the time.
bool stays(const scenario::ScanSweep& sweep);

/// Joins the azimuths that a beam passes, so that each occurs once. The largest values depend only on these,
/// so that intervals of at least one sweep there and back have the same pattern whenever they begin.
void joinArcs(std::vector<scenario::SweptArc>& arcs);

}  // namespace emscape::emfield
