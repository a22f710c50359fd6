#include "study/files/map_metadata.h"

#include <fmt/format.h>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/clock.h"

namespace emscape::study {

std::string noValueText(const Map& map) {
  if (map.kind == MapKind::difference) return "NaN: A, B or both have no value";
  if (!map.floor) return "";
  return fmt::format("NaN: at most {} {}, below the ground, unknown or outside the area", *map.floor,
                     map.unit);
}

std::vector<std::pair<std::string, std::string>> metadataOf(const MapStudy& study, const Map& map) {
  auto metadata = metadataOf(*study.scenarios.front(), study.quantity, study.threshold, map);
  if (study.scenarios.size() > 1) {
    const scenario::Scenario& b = *study.scenarios.back();
    metadata.emplace_back("EMSCAPE_SCENARIO_B", b.name);
    metadata.emplace_back("EMSCAPE_SCENARIO_B_HASH", b.hash);
    if (const std::string changes = changesOf(b); !changes.empty())
      metadata.emplace_back("EMSCAPE_SCENARIO_B_CHANGES", changes);
  }
  return metadata;
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
  if (const std::string changes = changesOf(scenario); !changes.empty())
    metadata.emplace_back("EMSCAPE_SCENARIO_CHANGES", changes);
  if (map.floor) metadata.emplace_back("EMSCAPE_FLOOR", fmt::format("{}", *map.floor));
  if (const std::string text = noValueText(map); !text.empty())
    metadata.emplace_back("EMSCAPE_NO_VALUE", text);
  if (map.height) metadata.emplace_back("EMSCAPE_HEIGHT", describe(*map.height));
  if (map.time_s) {
    metadata.emplace_back("EMSCAPE_TIME_S", fmt::format("{}", *map.time_s));
    if (const std::string utc = utcAt(scenario.clock, *map.time_s); !utc.empty())
      metadata.emplace_back("EMSCAPE_TIME_UTC", utc);
  }
  return metadata;
}

}  // namespace emscape::study
