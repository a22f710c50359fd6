#include "propagation/p1812/model.h"

#include "propagation/clear_air/row.h"
#include "propagation/clear_air/single_path.h"

namespace emscape::propagation {
namespace {

template <class Real>
P1812Model<Real> p1812Model(const PathInputs& inputs) {
  const P1812Settings& settings = inputs.emitter.settings.p1812;
  P1812Model<Real> model;
  model.clear_air = clearAirModel<Real>(clearAirParameters(inputs, settings));
  model.sea_level_refractivity = Real(inputs.emitter.atmosphere.sea_level_refractivity);
  model.location_deviation_db =
      Real(p1812LocationDeviationDb(inputs.emitter.frequency_hz, settings.location_width_m));
  model.location_deviate = Real(normalDeviate(settings.location_percent / 100));
  model.clutter_height_m = Real(settings.clutter_height_m);
  return model;
}

}  // namespace

std::vector<Setting> p1812Settings() {
  constexpr auto kP1812 = &ModelSettings::p1812;
  std::vector<Setting> settings = clearAirSettings<kP1812>(kP1812Time);
  settings.push_back(numberSetting<kP1812, &P1812Settings::location_percent>(
      "location_percent", "percent", kP1812Location.min, kP1812Location.max,
      "of locations in which the loss is not exceeded; applies up to 10 m above the clutter"));
  settings.push_back(numberSetting<kP1812, &P1812Settings::location_width_m>(
      "location_width_m", "m", kP1812LocationWidth.min, kP1812LocationWidth.max,
      "width of the square of the locations"));
  return settings;
}

InputFaults checkP1812(const EmitterInputs& inputs) {
  const P1812Settings& settings = inputs.settings.p1812;
  InputFaults faults;
  checkInput(kP1812Frequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  checkInput(kP1812Time, settings.time_percent, InputOrigin::settings, faults);
  checkInput(kP1812Location, settings.location_percent, InputOrigin::settings, faults);
  checkInput(kP1812LocationWidth, settings.location_width_m, InputOrigin::settings, faults);
  checkInput(kClearAirLapseRate, settings.refractivity_lapse_rate, InputOrigin::settings, faults);
  return faults;
}

std::vector<std::string> p1812PathWarnings(const PathInputs& inputs) {
  return clearAirPathWarnings(kP1812Distance, inputs);
}

P1812Excess p1812Excess(const PathInputs& inputs) {
  return {p1812Model<float>(inputs), clearAirGround(inputs.emitter.settings.p1812, kP1812ClutterDistance_m),
          static_cast<float>(inputs.site.height_msl_m)};
}

Explanation explainP1812(const PathInputs& inputs, PathColumn& path) {
  const P1812Excess excess = p1812Excess(inputs);
  Explanation explanation;
  if (!isExplainable(path.excess_db(excess), path.column(), explanation)) return explanation;
  const auto model = p1812Model<double>(inputs);
  const ClearAirProfile profile(model.clear_air, path.column().profile, excess.ground,
                                inputs.site.height_msl_m);
  const P1812Path<double> made_of =
      p1812Path(model, profile.column(), static_cast<double>(path.column().height_msl_m[0]));
  explainClearAir(profile.column(), made_of.geometry, made_of.median,
                  inputs.emitter.settings.p1812.time_percent, explanation);
  explanation.add("locations", "percentage of locations", made_of.loss_db - made_of.median.loss_db);
  return explanation;
}

}  // namespace emscape::propagation
