/// Measured profiles of refractivity, from CSV files.
#pragma once

#include <string>
#include <vector>

#include "propagation/parabolic_equation/refractivity.h"

namespace emscape::scenario {

struct RefractivityFile {
  propagation::RefractivityAlongPath air;
  std::vector<std::string> warnings;  ///< each names the file
};

/// Columns height_msl_m (m) and either m_units or n_units, in any order; N becomes M = N + height / (6371 km)
/// 10^6. With a column range_m the rows of one range follow each other, and the ranges ascend. Heights ascend
/// within a profile of 2 to 256 rows.
/// @throws Error (bad_input) with line and column
RefractivityFile readRefractivity(const std::string& file);

}  // namespace emscape::scenario
