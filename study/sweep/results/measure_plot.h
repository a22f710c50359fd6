/// Plots of a measure over a parameter.
#pragma once

#include <string>
#include <vector>

namespace emscape::study {

struct MeasurePlot {
  std::string parameter, measure;   ///< titles of the axes
  std::vector<std::string> labels;  ///< of a parameter without numbers: of its positions 0, 1 ...; else empty
  bool is_logarithmic = false;      ///< axis of the parameter; all of its values are positive
  std::vector<double> x, y;         ///< one point per variant; NaN: left out
};

/// Draws points; up to 60 values of the parameter, their means as a line. Of more than 2000 points, the mean,
/// the smallest and the largest of each of up to 60 values or equal intervals are drawn instead.
/// @return SVG
std::string drawMeasure(const MeasurePlot& plot);

}  // namespace emscape::study
