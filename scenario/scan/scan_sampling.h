/// Sampling of a scanning beam by a scenario's time steps.
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

/// Says that several looks of a radar fall between two times, which all count with the probability at the
/// later one, and the step that separates them; empty for a scan without a period and for at most one.
/// @param times_s  ascending
std::string mergedLooksText(const std::string& radar, const ScanSpec& scan,
                            const std::vector<double>& times_s);

}  // namespace emscape::scenario
