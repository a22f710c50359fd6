/// What antenna files of all formats tell, before a gain is chosen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/antenna/cut.h"
#include "scenario/antenna/shapes.h"
#include "scenario/antenna/tables.h"

namespace emscape::scenario {

struct PatternFile {
  std::string format;  ///< "NSMA", "CSV grid", ...
  std::string name;    ///< of the antenna, for descriptions
  std::optional<double> gain_dbi;
  std::string gain_warning;                            ///< what was assumed of it
  std::optional<double> stated_az_deg, stated_el_deg;  ///< beamwidths that the file states
  StatedBand stated_band;
  GridNodes nodes;
  std::vector<float> amplitudes;      ///< at the nodes, azimuth fastest
  std::vector<std::string> notes;     ///< what was ignored and how angles were understood, one sentence each
  std::vector<std::string> warnings;  ///< contradictions within the file, and what was assumed
};

/// Reads a file by its content and ending.
/// @throws Error (bad_input) with line and column
PatternFile readPatternFile(const std::string& file);

/// The antenna of a file.
/// @param gain_dbi  NaN: that of the file
/// @param warnings  receives those of the file, and beamwidths that contradict its cuts
/// @throws Error (bad_input) without a gain
AntennaPtr antennaOf(const std::string& file, const PatternFile& pattern, double gain_dbi,
                     std::vector<std::string>& warnings);

/// MSI/Planet: .msi, .pln.
PatternFile readMsiPattern(const std::string& file);
/// CSV grid: columns `azimuth_deg,elevation_deg,attenuation_db`, rows in any order, one for every pair of the
/// azimuths and elevations in the file; coverage as for readCsvCuts(). Interpolation is linear in amplitude.
/// @throws Error (bad_input) with file, line and column; a missing row is named by its pair
PatternFile readGridPattern(const std::string& file);
/// CSV with other columns: theta and phi, or azimuth and elevation; gain, directivity or attenuation.
PatternFile readTablePattern(const std::string& file);
/// NSMA WG16.99.050: .adf. @see isNsma()
PatternFile readNsma(const std::string& file);
/// External pattern of STK: .ant, .pattern. @see isStkPattern()
PatternFile readStkPattern(const std::string& file);
/// SPLAT!: .az and .el beside it, or one of them.
PatternFile readSplat(const std::string& azimuth_file, const std::string& elevation_file);

/// Fills the pattern from cuts in the horizontal plane (angles clockwise) and in the vertical plane through
/// boresight (angles from the horizon ahead, 0, downwards to the nadir, 90, and the horizon behind, 180).
/// Between them, horizontal projection interpolation is used:
///
///     A(az, el) = max(0, H(az) + (1 - w) (V(-el) - H(0)) + w (V(180 + el) - H(180))),   w = |az| / 180
///
/// It reproduces both cuts in their planes, and gives the usual sum of the two attenuations near the beam;
/// towards the rear the back of the vertical cut replaces its front. Limits: away from both planes,
/// particularly to the sides and behind, it is an estimate with errors of about 10 dB; at the zenith and the
/// nadir it depends on azimuth.
///
/// Both cuts contain the direction ahead. Where the horizontal one is weaker there than the vertical one by
/// more than 3 dB, its azimuths count from another direction: az in w, H(0) and H(180) then count from its
/// maximum. This is a warning, as is a vertical cut that is weaker ahead with its maximum more than 45
/// degrees from the horizon; with less the horizontal cut is one through the maximum of a tilted beam.
///
/// @param file  names the cuts in warnings
///
/// @see F. Gil, A. R. Claro, J. M. Ferreira, C. Pardelinha, L. M. Correia, "A 3D interpolation method for
/// base-station-antenna radiation patterns", IEEE Antennas and Propagation Magazine 43(2), 2001
void fillFromCuts(const std::string& file, const MeasuredCut& horizontal, const MeasuredCut& vertical,
                  PatternFile& pattern);

/// Angle (deg) of a cut's maximum.
double peakAngle_deg(const MeasuredCut& cut);

/// Adds "ignored: 3 lines (A, B, C)" to notes, unless there is none.
void noteIgnored(PatternFile& pattern, const char* what, const std::vector<std::string>& ignored);

}  // namespace emscape::scenario
