/// Sampling of beams by a scenario's time steps and voxels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/scan/scan.h"

namespace emscape::scenario {

struct ScanSampling {
  double step_deg = 0;   ///< azimuth that the beam sweeps in one time step
  double lit_share = 0;  ///< fraction 0..1 of the azimuths of its turn or sector that are within half a
                         ///< beamwidth of the beam at one of the clock's times
};

/// @param beamwidth_az_deg  between half-power points
/// @return none for beams that do not sweep and for a clock of a single time
std::optional<ScanSampling> scanSampling(const ScanSpec& scan, double beamwidth_az_deg, const Clock& clock);

/// True if steps larger than half a beamwidth leave azimuths that are never illuminated.
bool leavesGaps(const ScanSampling& sampling, double beamwidth_az_deg);

/// Azimuths that beams sweep between the times of a clock and illuminate at none of them.
struct UnlitAzimuths {
  std::size_t first_emitter = 0;  ///< of those concerned
  std::string warning;            ///< one line about all of them; beams of the same width and rate together
};

/// @return none if the output does not show scans at a time, or if beams illuminate all azimuths
std::optional<UnlitAzimuths> unlitAzimuths(const Scenario& scenario, const Clock& clock);

/// A beam that is narrower than the voxels of the region, so that it passes between their centres.
struct NarrowBeam {
  bool in_azimuth = true;  ///< of the antenna; else in elevation
  bool is_level = true;    ///< it passes between voxels side by side; else between layers
  double width_deg = 0, voxel_m = 0;
  double range_m = 0;  ///< from which no line of voxel centres passes through the beam between two of them
  Dims finer;          ///< of the region, with which this is at a fifth of its longer side at most
};

/// The plane in which an emitter's beam is as wide as a voxel only beyond a fifth of the region's longer
/// side, the one with the larger range; none if there is none, or if the beam does not stand still in that
/// plane: of radars that look at their targets, in intervals, and in the series of a beam that scans. The
/// attitude is that at the begin of the scenario.
std::optional<NarrowBeam> narrowBeam(const Scenario& scenario, const Emitter& emitter);
/// The same in words, with what helps: each remedy is tried.
std::string narrowBeamText(const Scenario& scenario, const Emitter& emitter, const NarrowBeam& beam);

/// Says which emitters switch on and off between times, so that these do not show it, with the step that
/// meets each; empty: none. Of many times of activity and pauses some may be missed, if the times have the
/// right share of both.
/// @param times_s  ascending
std::string missedActivityText(const Scenario& scenario, const std::vector<double>& times_s);

/// Says that several looks of a radar fall between two times, which all count with the probability at the
/// later one, and the step that separates them; empty for a scan without a period and for at most one.
/// @param times_s  ascending
std::string mergedLooksText(const std::string& radar, const ScanSpec& scan,
                            const std::vector<double>& times_s);

}  // namespace emscape::scenario
