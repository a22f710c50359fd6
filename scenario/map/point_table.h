/// Points in tables of text, by columns of latitude and longitude.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace emscape::scenario {

struct NamedPoint {
  std::string name;  ///< may be empty
  double latitude_deg = 0, longitude_deg = 0;
};

/// Reads a .csv or .tsv file with the columns latitude_deg and longitude_deg (or latitude, longitude,
/// lat, lon), and name, if wanted. Other columns are not used. Columns are separated by
/// commas, semicolons or tabs; numbers may have decimal commas, in quotes where commas separate.
/// @param others  receives their names; null: they are logged
/// @return none for other files, and for tables without these columns or with geometries (WKT)
/// @throws Error (bad_input) with line and column
std::optional<std::vector<NamedPoint>> readPointTable(const std::string& file,
                                                      std::vector<std::string>* others = nullptr);

}  // namespace emscape::scenario
