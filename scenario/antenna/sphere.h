/// Patterns that are measured over two angles, in the angles of other programs.
#pragma once

#include <string>
#include <vector>

#include "scenario/antenna/pattern_file.h"

namespace emscape::scenario {

/// Angles of a direction.
enum class SphereAngles {
  azimuth_elevation,    ///< clockwise from boresight; upwards
  theta_from_zenith,    ///< phi from boresight towards the left, theta from the zenith: boresight at 90, 0
  theta_from_boresight  ///< theta from boresight; phi from the left upwards
};

struct SphereRow {
  double first_deg = 0;   ///< azimuth or phi
  double second_deg = 0;  ///< elevation or theta, which may be negative: phi + 180, -theta
  double gain_db = 0;
  int line = 0;
};

struct SphereRange {
  double max_db = 0, min_db = 0;
};

/// Fills nodes and amplitudes from gains at every pair of angles; linear in amplitude between them. Where the
/// rows leave more than 90 degrees of azimuth (phi), or end before the pole, the smallest gain is used, with
/// a warning.
/// @param file  names rows in errors
/// @throws Error (bad_input) for a missing pair, or one with two gains
SphereRange fillFromSphere(SphereAngles angles, std::vector<SphereRow> rows, const std::string& file,
                           PatternFile& pattern);

}  // namespace emscape::scenario
