/// Common parts of the rows of `p1812` and `p452` in the registry.
#pragma once

#include <string>
#include <vector>

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/clear_air/excess.h"
#include "propagation/clear_air/loss.h"
#include "propagation/path_column.h"
#include "propagation/setting.h"

namespace emscape::propagation {

/// Keys of the settings in ClearAirSettings.
/// @tparam group  member of ModelSettings: &ModelSettings::p1812
template <auto group>
std::vector<Setting> clearAirSettings(const ModelLimit& time) {
  return {
      numberSetting<group, &ClearAirSettings::time_percent>("time_percent", "percent", time.min, time.max,
                                                            "of the time in which the loss is not exceeded"),
      numberSetting<group, &ClearAirSettings::refractivity_lapse_rate>(
          "refractivity_lapse_rate", "", kClearAirLapseRate.min, kClearAirLapseRate.max,
          "N-units/km (Delta N), through the lowest km; rays are bent by it, not by k_factor"),
      choiceSetting<group, &ClearAirSettings::zone>(
          "zone",
          "radio-climatic zone of the paths; by_height: sea by the terrain's land cover, or where the "
          "terrain is at "
          "or below mean sea level; coastal land up to 100 m high within 50 km of it"),
      numberSetting<group, &ClearAirSettings::clutter_height_m>(
          "clutter_height_m", "m", 0, 100,
          "of buildings and trees on land along the paths, where no land cover is known: 0 open, 10 "
          "suburban, 15 urban or forest, 20 "
          "dense urban"),
  };
}

/// Parameters of the model for an emitter.
ClearAirParameters clearAirParameters(const PathInputs& inputs, const ClearAirSettings& settings);

/// @param clutter_distance_m  min distance of clutter from either antenna
ClearAirGround clearAirGround(const ClearAirSettings& settings, double clutter_distance_m);

/// Warnings of paths longer than a limit.
std::vector<std::string> clearAirPathWarnings(const ModelLimit& distance, const PathInputs& inputs);
/// Messages for ClearAirWarning bits.
std::vector<std::string> clearAirWarningMessages(unsigned warnings);

/// False if the path has no loss or an unknown loss; the explanation then gives the reason.
bool isExplainable(double excess_db, const ExcessColumn& column, Explanation& explanation);
/// Adds the parts of a loss, up to L_bc, and the circumstances.
void explainClearAir(const ClearAirColumn<double>& column, const ClearAirPath<double>& path,
                     const ClearAirLoss<double>& loss, double time_percent, Explanation& explanation);

}  // namespace emscape::propagation
