#include "study/sweep/measure.h"

#include <algorithm>
#include <cmath>

namespace emscape::study {

void MeasureOverTime::add(const StudyMeasure& measure, const CoverageMap& map, const MapGrid& grid,
                          const std::vector<std::uint8_t>& pixels) {
  using Figure = StudyMeasure::Figure;
  const auto area_class = static_cast<float>(info(measure.product).area_class);
  double known_m2 = 0, of_class_m2 = 0, integral = 0, min = HUGE_VAL, max = -HUGE_VAL;
  const bool is_of_area = measure.figure == Figure::km2 || measure.figure == Figure::percent;
  const bool is_told = is_of_area && pixels.empty();  // by the map
  if (is_told) {
    known_m2 = map.known_area_m2;
    of_class_m2 = map.class_area_m2;
  }
  for (std::size_t p = 0; p < map.values.size() && !is_told; ++p) {
    const float value = map.values[p];
    if (std::isnan(value) || (!pixels.empty() && pixels[p] == 0)) continue;
    const auto area_m2 = static_cast<double>(grid.areas_m2[p]);
    known_m2 += area_m2;
    if (value == area_class) of_class_m2 += area_m2;
    integral += static_cast<double>(value) * area_m2;
    min = std::min(min, static_cast<double>(value));
    max = std::max(max, static_cast<double>(value));
  }
  if (measure.figure == Figure::km2) {
    sum_ += of_class_m2 / 1e6;
  } else if (known_m2 == 0) {
    return;
  } else {
    sum_ += measure.figure == Figure::percent ? 100 * of_class_m2 / known_m2 : integral / known_m2;
  }
  min_ = std::min(min_, min);
  max_ = std::max(max_, max);
  ++count_;
}

double MeasureOverTime::value(const StudyMeasure& measure) const {
  if (count_ == 0) return NAN;
  if (measure.figure == StudyMeasure::Figure::min) return min_;
  if (measure.figure == StudyMeasure::Figure::max) return max_;
  return sum_ / count_;
}

}  // namespace emscape::study
