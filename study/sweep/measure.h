/// Measures: one number of a map.
#pragma once

#include <cstdint>
#include <vector>

#include "emscape/study/maps/map_grid.h"
#include "study/sweep/definition/study_file.h"

namespace emscape::study {

/// Measures maps of one product and height, one per time or one for all.
class MeasureOverTime {
 public:
  /// @param pixels  1: counts; empty: all count
  void add(const StudyMeasure& measure, const CoverageMap& map, const MapGrid& grid,
           const std::vector<std::uint8_t>& pixels);
  /// The mean over the maps; for min and max, the smallest and the largest. NaN without a value.
  double value(const StudyMeasure& measure) const;

 private:
  double sum_ = 0, min_ = HUGE_VAL, max_ = -HUGE_VAL;
  int count_ = 0;
};

}  // namespace emscape::study
