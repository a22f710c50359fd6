/// Measured profiles of refractivity: CSV files and soundings of IGRA 2.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "propagation/parabolic_equation/air/refractivity_field.h"

namespace emscape::scenario {

struct RefractivityFile {
  propagation::RefractivityField field;
  std::string description;            ///< "3 profiles by range", "sounding of USM00072649, 2023-11-18T12Z"
  std::vector<std::string> warnings;  ///< each names the file
};

/// Columns height_msl_m (m) and either m_units, n_units, or pressure_hpa, temperature_k and
/// relative_humidity_percent, in any order; N becomes M = N + height / (6371 km) 10^6. With a column range_m,
/// or columns latitude_deg and longitude_deg, there are several profiles; the rows of each are consecutive,
/// and ranges ascend. Heights ascend within a profile of 2 to 256 rows.
/// @throws Error (bad_input) with line and column
RefractivityFile readRefractivity(const std::string& file);

/// True if a file begins like a file for readSounding().
bool isSoundingFile(const std::string& file);
/// True if a CSV file has a header for readRefractivity().
bool isRefractivityCsv(const std::string& file);

/// One sounding of a file of IGRA 2 (fixed columns, see docs/parabolic-equation.md): the levels with pressure
/// and temperature up to 10 km. Missing heights follow from the hydrostatic equation. Levels without humidity
/// are left out below the highest level that has it, and are dry above. Thinned to 0.5 M-units.
/// @param time_ms  from 1970 on, UTC: the sounding nearest to it; none: the file's last
/// @throws Error (bad_input) with line and column
RefractivityFile readSounding(const std::string& file, std::optional<std::int64_t> time_ms);

}  // namespace emscape::scenario
