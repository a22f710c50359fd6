#include "study/files/map_metadata.h"

#include <fmt/format.h>

#include "emscape/scenario/model/clock.h"

namespace emscape::study {

std::vector<std::pair<std::string, std::string>> metadataOf(const MapStudy& study, const Map& map) {
  return metadataOf(*study.scenarios.front(), study.quantity, study.threshold, map);
}

std::vector<std::pair<std::string, std::string>> metadataOf(const scenario::Scenario& scenario,
                                                            scenario::Quantity quantity, double threshold,
                                                            const Map& map) {
  std::vector<std::pair<std::string, std::string>> metadata{
      {"EMSCAPE_SCENARIO", scenario.name},
      {"EMSCAPE_SCENARIO_HASH", scenario.hash},
      {"EMSCAPE_PRODUCT", map.name},
      {"EMSCAPE_QUANTITY", scenario::info(quantity).name},
      {"EMSCAPE_THRESHOLD", fmt::format("{}", threshold)},
      {"EMSCAPE_HEIGHT_DATUM", "EGM96 (EPSG:5773)"},
      {"EMSCAPE_VERSION", EMSCAPE_VERSION}};
  if (map.height) metadata.emplace_back("EMSCAPE_HEIGHT", describe(*map.height));
  if (map.time_s) {
    metadata.emplace_back("EMSCAPE_TIME_S", fmt::format("{}", *map.time_s));
    if (const std::string utc = utcAt(scenario.clock, *map.time_s); !utc.empty())
      metadata.emplace_back("EMSCAPE_TIME_UTC", utc);
  }
  return metadata;
}

}  // namespace emscape::study
