/// Measured profiles of refractivity: CSV files and soundings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"

namespace emscape::scenario {

/// Where and when a sounding was made.
struct SoundingOrigin {
  std::string station, time_utc;
  std::int64_t time_ms = 0;
  std::optional<GeodeticPosition> position;  ///< none: the file does not have it
};

/// The largest number of levels of a profile.
constexpr std::size_t kMaxProfileLevels = 256;

/// Levels of a profile, no more than kMaxProfileLevels.
struct ThinnedLevels {
  std::vector<propagation::RefractivityLevel> levels;
  std::size_t count_before = 0;
  double tolerance = 0;  ///< largest departure (M-units) at the levels that were left out

  /// ", thinned from 6000 to 90 within 0.5 M-units"; empty if all are there.
  std::string text() const;
};
/// Thinned to 0.5 M-units, or to as many as are needed for that number of levels.
ThinnedLevels thinnedToLimit(const std::vector<propagation::RefractivityLevel>& levels);

struct RefractivityFile {
  propagation::RefractivityField field;
  std::string description;            ///< "3 profiles by range", "sounding of USM00072649, 2023-11-18T12Z"
  std::vector<std::string> warnings;  ///< each names the file
  std::optional<SoundingOrigin> sounding;  ///< none: profiles
};

/// Columns height_msl_m (m) and either m_units, n_units, or pressure_hpa, temperature_k and
/// relative_humidity_percent, in any order; N becomes M = N + height / (6371 km) 10^6. With a column range_m,
/// or columns latitude_deg and longitude_deg, there are several profiles; the rows of each are consecutive,
/// and ranges ascend. Heights ascend within a profile of 2 rows or more; more
/// than 256 are thinned.
/// @throws Error (bad_input) with line and column
RefractivityFile readRefractivity(const std::string& file);

/// True if a file begins like a file for readSounding().
bool isSoundingFile(const std::string& file);
/// True if a CSV file has a header for readRefractivity().
bool isRefractivityCsv(const std::string& file);
/// True for a table with pressures and temperatures in other columns than those of refractivity.
bool isTableOfAir(const std::string& file);
/// The columns that a CSV file of refractivity has, for messages.
const char* refractivityColumns();

/// One sounding of a file of IGRA 2, of the University of Wyoming or of the Storm Prediction Center (see
/// docs/parabolic-equation.md): the levels with pressure and temperature up to 10 km. Missing heights follow
/// from the hydrostatic equation. Levels without humidity are left out below the highest level that has it,
/// and are dry above. Thinned to 0.5 M-units.
/// @param time_ms  from 1970 on, UTC: the usable sounding nearest to it; none: the file's last usable one
/// @throws Error (bad_input) with line and column
RefractivityFile readSounding(const std::string& file, std::optional<std::int64_t> time_ms);

}  // namespace emscape::scenario
