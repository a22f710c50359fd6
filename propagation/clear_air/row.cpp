#include "propagation/clear_air/row.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace emscape::propagation {

ClearAirParameters clearAirParameters(const PathInputs& inputs, const ClearAirSettings& settings) {
  ClearAirParameters parameters;
  parameters.frequency_hz = inputs.emitter.frequency_hz;
  parameters.time_percent = settings.time_percent;
  parameters.latitude_deg = inputs.site.latitude_deg;
  parameters.lapse_rate = settings.refractivity_lapse_rate;
  parameters.polarization = linearPolarization(inputs.emitter.polarization);
  return parameters;
}

ClearAirGround clearAirGround(const ClearAirSettings& settings, double clutter_distance_m) {
  return {settings.zone, static_cast<float>(settings.clutter_height_m), clutter_distance_m};
}

std::vector<std::string> clearAirPathWarnings(const ModelLimit& distance, const PathInputs& inputs) {
  const double farthest_m = std::max(inputs.extent.farthest_m, distance.min * distance.si_per_unit);
  if (distance.holds(farthest_m)) return {};
  return {outsideMessage(distance, farthest_m)};
}

std::vector<std::string> clearAirWarningMessages(unsigned warnings) {
  std::vector<std::string> messages;
  if ((warnings & kClearAirTransmitterHeight) != 0) {
    messages.push_back(fmt::format("transmitter: {}", outsideMessage(kClearAirHeight)));
  }
  if ((warnings & kClearAirVoxelHeight) != 0) {
    messages.push_back(fmt::format("on some paths: {}", outsideMessage(kClearAirHeight)));
  }
  return messages;
}

bool isExplainable(double excess_db, const ExcessColumn& column, Explanation& explanation) {
  if (column.profile.count < 2) {
    explanation.why = "at the antenna itself";
    return false;
  }
  if (!std::isnan(excess_db)) return true;
  explanation.add("terrain", "terrain is missing", excess_db);
  explanation.why = "terrain is missing on the path";
  return false;
}

void explainClearAir(const ClearAirColumn<double>& column, const ClearAirPath<double>& path,
                     const ClearAirLoss<double>& loss, double time_percent, Explanation& explanation) {
  const double gases_db = loss.sight.median_db - loss.sight.free_space_db;
  if (gases_db > 0)
    explanation.add("gases_in_model", "oxygen and water vapour, as the model has them", gases_db);
  explanation.add("focusing", "focusing and multipath", loss.sight.loss_db - loss.sight.median_db);
  explanation.add("diffraction", "diffraction (delta-Bullington)", loss.diffraction.loss_db);
  explanation.add("ducting", "less by ducts and layers", loss.without_scatter_db - loss.diffraction_db);
  explanation.add("troposcatter", "less by troposcatter", loss.loss_db - loss.without_scatter_db);
  explanation.why =
      fmt::format("{} for {:.4g} % of the time; ducts form in {:.3g} % of it; {:.0f} % of the path is sea",
                  path.is_transhorizon ? "a path beyond the horizon" : "a line of sight", time_percent,
                  column.ducting_time_percent, 100 * column.zones.sea_fraction);
}

}  // namespace emscape::propagation
