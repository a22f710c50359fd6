#include "emscape/study/maps/map.h"

#include <fmt/format.h>

#include <cmath>

namespace emscape::study {

std::string fileNameOf(const Map& map) {
  std::string name = map.name;
  if (map.height) name += "_" + nameOf(*map.height);
  if (map.time_s) name += fmt::format("_t{}s", *map.time_s);
  return name;
}

std::string figureText(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "none";
  // Digits that the accuracy of the figure justifies.
  if (unit == "km2") return fmt::format("{:.3f}", value);
  if (unit == "percent" || unit.rfind("dB", 0) == 0) return fmt::format("{:.2f}", value);
  if (unit == "m") return fmt::format("{:.1f}", value);
  if (unit.empty()) return fmt::format("{:.4f}", value);
  return fmt::format("{:.4g}", value);
}

MapSummary summaryOf(const MapGrid& grid, const Map& map) {
  MapSummary summary;
  summary.min = summary.max = NAN;
  if (map.kind == MapKind::category || map.kind == MapKind::classes)
    summary.label_areas_m2.assign(map.labels.size(), 0);
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    const auto value = static_cast<double>(map.values[p]);
    const auto area_m2 = static_cast<double>(grid.areas_m2[p]);
    if (!map.answers.empty() && map.answers[p] == PixelAnswer::unknown) summary.unknown_area_m2 += area_m2;
    if (std::isnan(value)) continue;
    summary.known_area_m2 += area_m2;
    if (map.area_class >= 0 && value == map.area_class) summary.class_area_m2 += area_m2;
    if (value >= 0 && value < static_cast<double>(summary.label_areas_m2.size()))
      summary.label_areas_m2[static_cast<std::size_t>(value)] += area_m2;
    if (!(value >= summary.min)) summary.min = value;
    if (!(value <= summary.max)) {
      summary.max = value;
      summary.largest_pixel = static_cast<long long>(p);
    }
  }
  if (map.unreached_area_m2) {
    summary.class_area_m2 = summary.known_area_m2;
    summary.known_area_m2 += *map.unreached_area_m2;
  }
  return summary;
}

}  // namespace emscape::study
