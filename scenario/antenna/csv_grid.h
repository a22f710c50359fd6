/// Measured grids over azimuth and elevation, from CSV files.
#pragma once

#include <string>
#include <vector>

#include "scenario/antenna/cut.h"

namespace emscape::scenario {

/// A column of a CSV file and the range of its values.
struct ColumnSpec {
  const char* name;
  double lowest, highest;
  const char* unit;
};

/// Values at every pair of the axes' angles.
struct MeasuredGrid {
  MeasuredAxis azimuth, elevation;
  std::vector<double> values;  ///< azimuth fastest

  /// Bilinear between the angles.
  double valueAt(const AxisSample& at_azimuth, const AxisSample& at_elevation) const;
};

/// Reads a file with exactly the columns azimuth_deg, elevation_deg and `value`, in any order.
/// @param allows_azimuth_alone  without elevation_deg the values are those of all elevations
/// @throws Error (bad_input) with line and column
MeasuredGrid readMeasuredGrid(const std::string& file, const ColumnSpec& value,
                              bool allows_azimuth_alone = false);

}  // namespace emscape::scenario
