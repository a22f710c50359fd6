#include "propagation/p452/model.h"

#include "propagation/air/gases.h"
#include "propagation/clear_air/row.h"
#include "propagation/clear_air/single_path.h"

namespace emscape::propagation {
namespace {

P452Parameters p452Parameters(const PathInputs& inputs) {
  const P452Settings& settings = inputs.emitter.settings.p452;
  const Atmosphere& atmosphere = inputs.emitter.atmosphere;
  P452Parameters parameters;
  parameters.clear_air = clearAirParameters(inputs, settings);
  parameters.sea_level_refractivity = atmosphere.sea_level_refractivity;
  const AirState air{atmosphere.pressure_hpa, atmosphere.temperature_k, kP452LandVapour_g_m3};
  parameters.dry_pressure_hpa = air.pressure_hpa - air.vapourPressure_hpa();
  parameters.temperature_k = atmosphere.temperature_k;
  parameters.gains_dbi = settings.transmitter_gain_dbi + settings.receiver_gain_dbi;
  return parameters;
}

}  // namespace

std::vector<Setting> p452Settings() {
  constexpr auto kP452 = &ModelSettings::p452;
  std::vector<Setting> settings = clearAirSettings<kP452>(kP452Time);
  settings.push_back(numberSetting<kP452, &P452Settings::transmitter_gain_dbi>(
      "transmitter_gain_dbi", "dBi", -20, 60,
      "of the antenna toward the horizon, for the loss of coupling into troposcatter"));
  settings.push_back(numberSetting<kP452, &P452Settings::receiver_gain_dbi>(
      "receiver_gain_dbi", "dBi", -20, 60, "the same of the antenna at the other end"));
  return settings;
}

InputFaults checkP452(const EmitterInputs& inputs) {
  const P452Settings& settings = inputs.settings.p452;
  InputFaults faults;
  checkInput(kP452Frequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  checkInput(kP452Time, settings.time_percent, InputOrigin::settings, faults);
  checkInput(kClearAirLapseRate, settings.refractivity_lapse_rate, InputOrigin::settings, faults);
  return faults;
}

std::vector<std::string> p452PathWarnings(const PathInputs& inputs) {
  return clearAirPathWarnings(kP452Distance, inputs);
}

P452Excess p452Excess(const PathInputs& inputs) {
  return {p452Model<float>(p452Parameters(inputs)),
          clearAirGround(inputs.emitter.settings.p452, kP452ClutterDistance_m),
          static_cast<float>(inputs.site.height_msl_m)};
}

Explanation explainP452(const PathInputs& inputs, PathColumn& path) {
  const P452Excess excess = p452Excess(inputs);
  Explanation explanation;
  if (!isExplainable(path.excess_db(excess), path.column(), explanation)) return explanation;
  const auto model = p452Model<double>(p452Parameters(inputs));
  const ClearAirProfile profile(model.clear_air, path.column().profile, excess.ground,
                                inputs.site.height_msl_m);
  const P452Path<double> made_of =
      p452Path(model, profile.column(), static_cast<double>(path.column().height_msl_m[0]));
  explainClearAir(profile.column(), made_of.geometry, made_of.loss, inputs.emitter.settings.p452.time_percent,
                  explanation);
  return explanation;
}

}  // namespace emscape::propagation
