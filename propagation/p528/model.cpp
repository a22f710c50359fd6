#include "propagation/p528/model.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "propagation/p528/p528.h"

namespace emscape::propagation {

std::vector<Setting> p528Settings() {
  return {numberSetting<&ModelSettings::p528, &P528Settings::time_percent>(
      "time_percent", "percent", kP528Percentage.min, kP528Percentage.max,
      "percentage of time for which the loss is not exceeded")};
}

InputFaults checkP528(const EmitterInputs& inputs) {
  InputFaults faults;
  checkInput(kP528Frequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  checkInput(kP528Percentage, inputs.settings.p528.time_percent, InputOrigin::settings, faults);
  return faults;
}

std::vector<std::string> p528PathWarnings(const PathInputs& inputs) {
  return smoothHeightWarnings(kP528Height, inputs);
}

Explanation explainP528(const PathInputs& inputs, PathColumn& path) {
  const EmitterInputs& emitter = inputs.emitter;
  const double time_percent = emitter.settings.p528.time_percent;
  const auto allowed = [&](double height_msl_m) {
    return std::clamp(height_msl_m - inputs.surface_msl_m, kP528Height.min, kP528Height.max);
  };
  const P528Curve curve(std::make_shared<const P528Atmosphere>(emitter.frequency_hz), emitter.frequency_hz,
                        allowed(inputs.site.height_msl_m), allowed(inputs.extent.highest_msl_m),
                        emitter.polarization != Polarization::horizontal);
  const P528Loss loss = curve.at(path.column().range_m, time_percent);
  const auto modeName = [](P528Mode mode) {
    switch (mode) {
      case P528Mode::line_of_sight:
        return "line of sight";
      case P528Mode::diffraction:
        return "diffraction";
      case P528Mode::troposcatter:
        return "scatter by the troposphere";
    }
    return "";
  };
  Explanation explanation;
  explanation.add("p528", modeName(loss.mode), loss.loss_db - loss.free_space_db - loss.absorption_db);
  explanation.add("p528_gases", "oxygen and water vapour, as P.528 has them", loss.absorption_db);
  explanation.why = fmt::format(
      "over a smooth earth {:.1f} m above mean sea level, not exceeded {:g} % of the time; "
      "terrain has no part in it",
      inputs.surface_msl_m, time_percent);
  return explanation;
}

}  // namespace emscape::propagation
