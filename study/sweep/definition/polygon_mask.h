/// The part of a map that polygons cover.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emscape/study/maps/map_grid.h"

namespace emscape::study {

/// The pixels whose centres are in the polygons of a file: 1, others 0. Edges are straight in the file's own
/// coordinate system; without one, corners are longitudes and latitudes of WGS84. Within a polygon rings
/// count by the even-odd rule.
/// @throws Error (bad_input) that names the file: not readable, no polygon, none of the map's pixels, a ring
/// with fewer than 3 corners, an edge over more than 180 degrees of longitude
std::vector<std::uint8_t> pixelsWithin(const std::string& file, const MapGrid& grid);

}  // namespace emscape::study
