/// Losses in a text file of AREPS, and their comparison with our own.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/study/vertical/vertical.h"
#include "report/json.h"

namespace emscape::report {

/// The table of losses over range and height.
struct ArepsTable {
  double bearing_deg = 0;  ///< NaN: not told
  double max_range_m = 0;  ///< the first of the ranges is that over their number
  double min_height_m = 0, max_height_m = 0;
  int ranges = 0, heights = 0;
  std::vector<float> loss_db;  ///< ranges x heights, range fastest; NaN: below the ground or invalid

  /// Between the four points around, linear; NaN where one of them is, and outside.
  double at_db(double range_m, double height_m) const;
};

/// @param text  of the file: Rmax, Hmin and Hmax (m), Nrout and Nzout, Bearing angle, and the section Apm
/// Loss Data in tenths of a decibel
/// @throws Error (bad_input) naming file and line
ArepsTable parseAreps(const std::string& file, const std::string& text);
ArepsTable readAreps(const std::string& file);

/// Differences of losses, ours less theirs, at the points of a diagram.
struct ArepsComparison {
  long long points = 0;  ///< at which both have a loss
  long long only_ours = 0, only_theirs = 0;
  double mean_db = 0, deviation_db = 0, largest_db = 0;
  double range_m = 0, height_m = 0;  ///< of the largest one
};
/// @param diagram  of one azimuth, as for writeAreps()
ArepsComparison compareAreps(const study::VerticalDiagram& diagram, const scenario::Scenario& scenario,
                             const ArepsTable& table);
std::string arepsComparisonText(const ArepsComparison& comparison, const std::string& file);
Json arepsComparisonJson(const ArepsComparison& comparison, const std::string& file);

}  // namespace emscape::report
