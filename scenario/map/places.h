/// Named points, lines and areas that a user shows on the ground.
#pragma once

#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"

namespace emscape::scenario {

struct Place {
  enum class Kind { point, line, area };
  Kind kind = Kind::point;
  std::string name;  ///< may be empty
  /// Points; lines; or the rings of an area's polygons. At height 0.
  std::vector<std::vector<GeodeticPosition>> parts;
};

/// Reads the features of a GeoPackage, GeoJSON or another vector file (VectorFile), of all its layers; their
/// name is in a field `name`, in capitals or not. Features without a geometry are left out.
/// @throws Error (bad_input) naming the file, also for more than kMaxPlaceVertices points and for positions
/// without longitude and latitude
std::vector<Place> readPlaces(const std::string& file);

constexpr int kMaxPlaceVertices = 2000000;

}  // namespace emscape::scenario
