#include "propagation/itm/model.h"

#include <fmt/core.h>

#include "emscape/base/error.h"
#include "propagation/diffraction/model.h"

namespace emscape::propagation {
namespace {

ItmClimate itmClimate(RadioClimate climate) {
  switch (climate) {
    case RadioClimate::equatorial:
      return ItmClimate::equatorial;
    case RadioClimate::continental_subtropical:
      return ItmClimate::continental_subtropical;
    case RadioClimate::maritime_subtropical:
      return ItmClimate::maritime_subtropical;
    case RadioClimate::desert:
      return ItmClimate::desert;
    case RadioClimate::continental_temperate:
      return ItmClimate::continental_temperate;
    case RadioClimate::maritime_temperate_over_land:
      return ItmClimate::maritime_temperate_over_land;
    case RadioClimate::maritime_temperate_over_sea:
      return ItmClimate::maritime_temperate_over_sea;
  }
  throw Error(ErrorCode::other, "itm: unknown climate");
}

/// ITM's mode of variability (mdvar, 0..3).
int itmVariability(ItmService service) {
  switch (service) {
    case ItmService::single_message:
      return 0;
    case ItmService::individual:
      return 1;
    case ItmService::mobile:
      return 2;
    case ItmService::broadcast:
      return 3;
  }
  throw Error(ErrorCode::other, "itm: unknown service");
}

ItmQuantiles<float> itmQuantiles(const ItmSettings& settings) {
  return {static_cast<float>(settings.time_percent), static_cast<float>(settings.location_percent),
          static_cast<float>(settings.situation_percent)};
}

}  // namespace

std::vector<Setting> itmSettings() {
  constexpr auto kItm = &ModelSettings::itm;
  const auto percent = [](auto row, const char* key, const char* description) {
    return row(key, "percent", 0.01, 99.99, description);
  };
  return {
      choiceSetting<kItm, &ItmSettings::form>(
          "form", "point_to_point: over the terrain's profiles; area: over terrain of irregularity_m"),
      percent(numberSetting<kItm, &ItmSettings::time_percent>, "time_percent",
              "percentage of time for which the loss is not exceeded"),
      percent(numberSetting<kItm, &ItmSettings::location_percent>, "location_percent",
              "of locations; area form only"),
      percent(numberSetting<kItm, &ItmSettings::situation_percent>, "situation_percent",
              "of situations (confidence)"),
      choiceSetting<kItm, &ItmSettings::service>("service", "kind of statistics"),
      numberSetting<kItm, &ItmSettings::irregularity_m>(
          "irregularity_m", "m", 0, 1000,
          "of the terrain, area form: 0 sea, 30 plains, 90 hills, 200 mountains"),
      choiceSetting<kItm, &ItmSettings::transmitter_siting>("transmitter_siting", "area form"),
      choiceSetting<kItm, &ItmSettings::receiver_siting>("receiver_siting", "area form"),
  };
}

InputFaults checkItm(const EmitterInputs& inputs) {
  InputFaults faults;
  checkInput(kItmFrequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  checkInput(kItmProvenFrequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  // Checks that do not depend on the path, by a valid path.
  ItmLink<float> link = itmLink(inputs);
  link.height_agl_m[0] = link.height_agl_m[1] = 10;
  ItmArea<float> area;
  area.distance_m = 10e3f;
  area.irregularity_m = static_cast<float>(inputs.settings.itm.irregularity_m);
  const ItmResult<float> trial = itmAreaMode(area, link, itmQuantiles(inputs.settings.itm));
  if (!trial.refused()) return faults;
  const bool is_ground = trial.status == ItmStatus::permittivity || trial.status == ItmStatus::conductivity ||
                         trial.status == ItmStatus::ground_impedance;
  faults.push_back({is_ground ? InputOrigin::ground : InputOrigin::settings, true, itmMessage(trial.status)});
  return faults;
}

std::vector<std::string> itmWarningMessages(unsigned warnings) {
  std::vector<std::string> messages;
  std::string all;
  for (const std::string& message : itmMessages(warnings & ~(kMissingTerrain | kItmRefused))) {
    all += (all.empty() ? "on some paths: " : "; ") + message;
  }
  if (!all.empty()) messages.push_back(all);
  if ((warnings & kItmRefused) != 0) {
    messages.push_back(
        "paths refused, 'diffraction' is used instead: the refractivity at the surface "
        "or the effective earth is outside the model's limits");
  }
  return messages;
}

ItmLink<float> itmLink(const EmitterInputs& inputs) {
  const GroundConstants ground = groundConstants(inputs.ground, inputs.frequency_hz);
  const ItmSettings& settings = inputs.settings.itm;
  ItmLink<float> link;
  link.frequency_hz = static_cast<float>(inputs.frequency_hz);
  link.vertical_polarization = linearPolarization(inputs.polarization) == LinearPolarization::vertical;
  link.relative_permittivity = static_cast<float>(ground.relative_permittivity);
  link.conductivity_s_m = static_cast<float>(ground.conductivity_s_per_m);
  link.sea_level_refractivity = static_cast<float>(inputs.atmosphere.sea_level_refractivity);
  link.climate = itmClimate(inputs.atmosphere.climate);
  // With a known terrain there is no location variability: mode + 10.
  link.variability_mode =
      itmVariability(settings.service) + (settings.form == ItmForm::point_to_point ? 10 : 0);
  return link;
}

ItmExcess itmExcess(const PathInputs& inputs) {
  const ItmSettings& settings = inputs.emitter.settings.itm;
  ItmExcess excess;
  excess.diffraction = diffractionExcess(inputs);
  excess.link = itmLink(inputs.emitter);
  excess.quantiles = itmQuantiles(settings);
  excess.is_area = settings.form == ItmForm::area;
  excess.area.irregularity_m = static_cast<float>(settings.irregularity_m);
  excess.area.siting[0] = settings.transmitter_siting;
  excess.area.siting[1] = settings.receiver_siting;
  excess.step_m = inputs.post_spacing_m;  // spacing of the posts
  return excess;
}

Explanation explainItm(const PathInputs& inputs, PathColumn& path) {
  const ItmExcess model = itmExcess(inputs);
  const ExcessColumn& column = path.column();
  const double loss_db = path.excess_db(model);
  const double diffraction_db = path.excess_db(model.diffraction);
  const auto heightWeight = [](float height_msl_m, float ground_msl_m) {
    return itmHeightWeight(static_cast<double>(height_msl_m) - static_cast<double>(ground_msl_m));
  };
  const double weight =
      static_cast<double>(itmRangeWeight(column.range_m) *
                          heightWeight(model.diffraction.tx_msl_m, column.profile.height_msl_m[0]) *
                          heightWeight(column.height_msl_m[0], column.ground_msl_m));
  Explanation explanation;
  explanation.add("itm", fmt::format("ITM by its weight, {:.2f}", weight),
                  loss_db - (1 - weight) * diffraction_db);
  explanation.add("diffraction", fmt::format("diffraction by the rest, {:.2f}", 1 - weight),
                  (1 - weight) * diffraction_db);
  explanation.why = weight == 1 ? "no end is too high, and the distance is within ITM's limits"
                    : weight == 0
                        ? "an end or the distance is outside ITM's limits: diffraction is used instead"
                        : "near ITM's limits: a weighted mean with diffraction";
  return explanation;
}

}  // namespace emscape::propagation
