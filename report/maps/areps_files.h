/// Vertical coverage as text files of AREPS, which SIMDIS draws.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/study/vertical/vertical.h"

namespace emscape::report {

/// FOLDER/NAME_APM_AZIMUTH.txt
std::string arepsFile(const std::filesystem::path& folder, const std::string& emitter, double azimuth_deg);

/// Writes arepsFile() for each azimuth: loss and propagation factor of the
/// path to an isotropic antenna, both with the emitter's antenna pattern relative to its gain, and for radars
/// the largest losses for probabilities of detection of 1 to 100 % (0.999).
/// @param diagram  of snr_db for a radar, whose beam is on the target, else of power_density_dbwm2; above
/// mean sea level, of this scenario
/// @return the written files
/// @throws Error (other) naming the file
std::vector<std::string> writeAreps(const study::VerticalDiagram& diagram, const scenario::Scenario& scenario,
                                    const std::filesystem::path& folder);

/// One-way loss (dB) of such a file at a value of the diagram's quantity.
double arepsLoss_db(const study::VerticalDiagram& diagram, const scenario::Scenario& scenario, double value);
/// The quantity of the diagram from which losses are known.
scenario::Quantity arepsQuantity(const scenario::Emitter& emitter);

}  // namespace emscape::report
