#include "emfield/model_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "emfield/excess/excess_model.h"
#include "emfield/models/horizon.h"
#include "emfield/models/p528.h"
#include "emfield/models/rain.h"
#include "emscape/base/error.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::PropagationModel;
using scenario::Scenario;

std::string inModel(const Emitter& emitter, const std::string& message, const char* model = nullptr) {
  return fmt::format("emitter '{}': '{}': {}", emitter.name,
                     model != nullptr ? model : scenario::toString(emitter.propagation), message);
}

/// Collects what lies outside limits; refused values are thrown.
class Checker {
 public:
  explicit Checker(const Emitter& emitter) : emitter_(emitter) {}

  void check(const ModelLimit& limit, double value_si, const SourceLocation& place) {
    if (limit.holds(value_si)) return;
    const std::string message = inModel(emitter_, outsideMessage(limit, value_si));
    if (limit.beyond == Beyond::refused) throw Error(ErrorCode::bad_input, place, message);
    warnings.push_back(message);
  }

  std::vector<std::string> warnings;

 private:
  const Emitter& emitter_;
};

void checkItm(const Scenario& scenario, const Emitter& emitter, Checker& checker) {
  checker.check(kItmFrequency, emitter.frequency_hz, emitter.frequency_place);
  checker.check(kItmProvenFrequency, emitter.frequency_hz, emitter.frequency_place);
  // All that does not depend on the path, on a path that nothing else is wrong with.
  ItmLink<float> link = itmLink(scenario, emitter);
  link.height_agl_m[0] = link.height_agl_m[1] = 10;
  ItmArea<float> area;
  area.distance_m = 10e3f;
  area.irregularity_m = static_cast<float>(emitter.itm.irregularity_m);
  const ItmResult<float> trial = itmAreaMode(area, link, itmQuantiles(emitter.itm));
  if (!trial.refused()) return;
  const bool is_ground = trial.status == ItmStatus::permittivity || trial.status == ItmStatus::conductivity ||
                         trial.status == ItmStatus::ground_impedance;
  throw Error(ErrorCode::bad_input, is_ground ? scenario.ground.place : emitter.itm.place,
              inModel(emitter, itmMessage(trial.status)));
}

}  // namespace

std::vector<std::string> checkModel(const Scenario& scenario, const Emitter& emitter) {
  Checker checker(emitter);
  const SourceLocation& frequency_place = emitter.frequency_place;
  switch (emitter.propagation) {
    case PropagationModel::free_space:
    case PropagationModel::horizon:
      break;
    case PropagationModel::diffraction:
      checker.check(kDiffractionFrequency, emitter.frequency_hz, frequency_place);
      break;
    case PropagationModel::two_ray:
      checker.check(kTwoRayFrequency, emitter.frequency_hz, frequency_place);
      checker.check(kTwoRayRoughness, scenario.ground.roughness_m, scenario.ground.place);
      break;
    case PropagationModel::itm:
      checkItm(scenario, emitter, checker);
      break;
    case PropagationModel::p528:
      checker.check(kP528Frequency, emitter.frequency_hz, frequency_place);
      checker.check(kP528Percentage, emitter.p528.time_percent, emitter.p528.place);
      break;
  }
  if (scenario.atmosphere.rain_mm_h > 0 && !kRainFrequency.holds(emitter.frequency_hz)) {
    checker.warnings.push_back(
        inModel(emitter, outsideMessage(kRainFrequency, emitter.frequency_hz), "rain"));
  }
  return checker.warnings;
}

std::vector<std::string> checkModels(const Scenario& scenario) {
  std::vector<std::string> warnings;
  for (const Emitter& emitter : scenario.emitters) {
    const std::vector<std::string> of_emitter = checkModel(scenario, emitter);
    warnings.insert(warnings.end(), of_emitter.begin(), of_emitter.end());
  }
  return warnings;
}

std::vector<std::string> pathWarnings(const Scenario& scenario, const Emitter& emitter,
                                      const scenario::EmitterState& state, const PathExtent& extent,
                                      const scenario::Terrain* terrain, unsigned remarks) {
  const Station station = makeStation(state.position, state.height_msl_m, scenario.atmosphere.k_factor);
  const double highest_msl_m = std::max(state.height_msl_m, extent.highest_msl_m);
  std::vector<std::string> messages = remarkMessages(emitter, remarks);
  const auto check = [&](const ModelLimit& limit, double value_si) {
    if (!limit.holds(value_si)) messages.push_back(outsideMessage(limit, value_si));
  };
  // Heights below ground are no voxels': only the upper limit of what the grid holds counts.
  const auto checkSmooth = [&](const ModelLimit& limit) {
    const double surface_msl_m = smoothSurface_msl_m(scenario, emitter, station, terrain);
    for (const double height_m :
         {state.height_msl_m - surface_msl_m, std::max(extent.highest_msl_m - surface_msl_m, limit.least)}) {
      if (limit.holds(height_m)) continue;
      messages.push_back(fmt::format("{} {:.6g} m is outside {:.6g}..{:.6g} m: taken as the nearest of these",
                                     limit.parameter, height_m, limit.least, limit.most));
    }
  };
  switch (emitter.propagation) {
    case PropagationModel::free_space:
      break;
    case PropagationModel::horizon:
      if (highest_msl_m > kLinearRefractivityHeight_m) {
        messages.push_back(
            fmt::format("takes refractivity as linear in height, which does not hold above {:.0f} m",
                        kLinearRefractivityHeight_m));
      }
      break;
    case PropagationModel::itm:
    case PropagationModel::diffraction:
      check(kDiffractionHeight, highest_msl_m);
      check(kDiffractionDistance, std::max(extent.farthest_m, 1e3));
      break;
    case PropagationModel::two_ray:
      checkSmooth(kTwoRayHeight);
      break;
    case PropagationModel::p528:
      checkSmooth(kP528Height);
      break;
  }
  for (std::string& message : messages) message = inModel(emitter, message);
  return messages;
}

}  // namespace emscape::emfield
