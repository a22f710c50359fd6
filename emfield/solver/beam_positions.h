/// The positions that represent a beam in an interval, for channels of occupancy.
#pragma once

#include <map>
#include <utility>

#include "emfield/combine/occupancy.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// PatternReach by antenna and elevation (deg) of the beam, kept between updates.
class PatternReaches {
 public:
  /// @accuracy levels are 1 dB too low, azimuths a step of the table too large, so that no position above a
  /// level is beyond it
  const PatternReach& of(const scenario::AntennaPtr& antenna, double elevation_deg);

 private:
  std::map<std::pair<scenario::AntennaPtr, double>, PatternReach> known_;
};

/// Number of positions of a sweep: a 20th of a beamwidth apart, or 1/1024 of the sweep if that is less, but
/// at most 16384.
int beamPositions(double width_deg, double beamwidth_deg);

/// Sets the frame and the positions of a share; the positions' shares add up to the part of the interval in
/// which the emitter is active.
/// @param state  active in the interval of the scenario's output that begins at t_s
void setPositions(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                  const scenario::EmitterState& state, double t_s, PatternReaches& reaches,
                  OccupancyShare& share);

}  // namespace emscape::emfield
