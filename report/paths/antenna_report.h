/// Antenna files, as JSON and as a plot of their cuts.
#pragma once

#include <string>
#include <vector>

#include "emscape/render/picture/image.h"
#include "emscape/scenario/antenna/antenna.h"
#include "report/json.h"
#include "scenario/antenna/pattern_file.h"

namespace emscape::report {

/// An antenna file: what it holds, what the pattern is, what was ignored.
struct AntennaReport {
  std::string file;
  scenario::PatternFile pattern;
  scenario::AntennaPtr antenna;       ///< with a gain of 0 dBi if the file has none
  std::vector<std::string> warnings;  ///< contradictions
};

/// @throws Error (bad_input) with line and column
AntennaReport readAntennaReport(const std::string& file);

/// Format, gain, beamwidths, directivity, direction of the maximum, notes and warnings.
Json antennaJson(const AntennaReport& report);

/// Plots the horizontal and the vertical cut through the maximum as polar diagrams, as .png or .svg.
/// @throws Error (other) naming the file
void plotAntenna(const AntennaReport& report, render::ImageSize size, const std::string& file);

}  // namespace emscape::report
