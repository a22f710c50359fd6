/// Candidates for the site of a platform.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/study/maps/area.h"
#include "scenario/map/point_heights.h"

namespace emscape::study {

struct CandidateSite {
  std::string name;
  double latitude_deg = 0, longitude_deg = 0;
  std::optional<scenario::PointHeight> height;  ///< none: that of the platform
};

/// The points of all layers of a file, in any CRS. Names are those of a field `name`, or "site N"; heights
/// those of a field that states what they are above (heightReferenceOf()). What is not used is logged.
/// @throws Error (bad_input) that names the file: not readable, no point, two of one name
std::vector<CandidateSite> readCandidates(const std::string& file);

/// Points at whole multiples of a distance from the middle of an area, within it, from north to south and
/// from west to east.
/// @throws Error (bad_input) for more than 10 000
std::vector<CandidateSite> candidatesOver(const MapArea& area, double distance_m);

}  // namespace emscape::study
