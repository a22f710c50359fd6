/// Points in tables of text, by columns of latitude and longitude or of a grid reference.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/map/point_heights.h"

namespace emscape::scenario {

struct NamedPoint {
  std::string name;  ///< may be empty
  double latitude_deg = 0, longitude_deg = 0;
  std::optional<PointHeight> height;
};

/// Reads a .csv or .tsv file, or a .zip with one, with the columns latitude_deg and longitude_deg (or
/// latitude, longitude, lat, lon), or with one of both (mgrs, utm, position, coordinates); if wanted, name
/// and a height (heightReferenceOf()). Other columns are not used. Columns are separated by commas,
/// semicolons or tabs; numbers may have decimal commas, in quotes where commas separate. Coordinates are
/// numbers or texts of parseCoordinate() and parsePosition(); longitudes from 180 to 360 are those to the
/// west.
/// @param others  receives the names of columns that are not used; null: they are logged
/// @return none for other files, and for tables without these columns or with geometries (WKT)
/// @throws Error (bad_input) with line and column
std::optional<std::vector<NamedPoint>> readPointTable(const std::string& file,
                                                      std::vector<std::string>* others = nullptr);

}  // namespace emscape::scenario
