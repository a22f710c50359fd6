#include "emscape/study/map.h"

#include <fmt/format.h>

#include <cmath>

namespace emscape::study {

std::string fileNameOf(const Map& map) {
  std::string name = map.name;
  if (map.height) name += "_" + nameOf(*map.height);
  if (map.time_s) name += fmt::format("_t{}s", *map.time_s);
  return name;
}

MapSummary summaryOf(const MapGrid& grid, const Map& map) {
  MapSummary summary{NAN, NAN};
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    const auto value = static_cast<double>(map.values[p]);
    if (std::isnan(value)) continue;
    const auto area_m2 = static_cast<double>(grid.areas_m2[p]);
    summary.known_area_m2 += area_m2;
    if (map.area_class >= 0 && value == map.area_class) summary.class_area_m2 += area_m2;
    if (!(value >= summary.min)) summary.min = value;
    if (!(value <= summary.max)) {
      summary.max = value;
      summary.largest_pixel = static_cast<long long>(p);
    }
  }
  return summary;
}

}  // namespace emscape::study
