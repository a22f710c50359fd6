#include "emfield/products.h"

#include "emfield/radar/receiver.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::Quantity;

/// What a channel of a radar quantity does with each radar's echo, before the look is known.
RadarTask radarTask(Quantity quantity, const Emitter& radar, const scenario::OutputSpec& output) {
  RadarTask task;
  task.echo_root = static_cast<float>(echoRoot_m2_w(radar));
  const bool looks_at_scan = quantity == Quantity::snr_db || quantity == Quantity::detection_probability;
  task.look = lookOf(radar, looks_at_scan ? output.radar_look : scenario::RadarLook::target);
  const double processing = dbToRatio(radar.receiver.processing_gain_db);
  switch (quantity) {
    case Quantity::detection_probability:
      task.measure = RadarMeasure::detection;
      task.reduction = output.combine == scenario::CombineMode::max ? Reduction::maximum : Reduction::sum;
      break;
    case Quantity::jammer_to_signal_db:
      task.measure = RadarMeasure::signal_to_jamming;
      task.factor = static_cast<float>(1 / processing);
      break;
    case Quantity::burn_through_margin_db:
      task.measure = RadarMeasure::signal_to_jamming;
      task.factor = static_cast<float>(dbToRatio(-requiredSignalToJammerDb(radar.receiver)));
      task.ceiling = kLargestMargin;
      break;
    default:
      break;
  }
  return task;
}

std::shared_ptr<const DetectionCurve> curveOf(
    const scenario::RadarReceiver& receiver,
    const std::vector<std::shared_ptr<const DetectionCurve>>& known_curves) {
  const Detector detector = detectorOf(receiver);
  for (const auto& curve : known_curves) {
    if (curve->isOf(detector, receiver.detection)) return curve;
  }
  return std::make_shared<const DetectionCurve>(detector, receiver.detection);
}

}  // namespace

const char* scaleOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::detection_probability:
      return volume::kProbabilityScale;
    case Quantity::jammer_to_signal_db:
      return volume::kRatioBelowScale;
    case Quantity::burn_through_margin_db:
      return volume::kRatioAboveScale;
    default:
      return nullptr;
  }
}

ChannelRecipe recipeOf(const Channel& channel, const scenario::Scenario& scenario,
                       const std::vector<std::shared_ptr<const DetectionCurve>>& known_curves) {
  ChannelRecipe recipe;
  recipe.product.floor = static_cast<float>(scenario.output.floor);
  if (scenario.output.combine == scenario::CombineMode::max) recipe.reduction = Reduction::maximum;
  recipe.weights.assign(channel.emitters.size(), 1.0f);
  const auto weigh = [&](auto weightOf) {
    for (std::size_t i = 0; i < channel.emitters.size(); ++i) {
      recipe.weights[i] = static_cast<float>(weightOf(scenario.emitters[channel.emitters[i]]));
    }
  };
  switch (channel.quantity) {
    case Quantity::power_density_dbwm2:
      break;
    case Quantity::field_strength_dbuvm:
      recipe.product.offset_db = static_cast<float>(kFieldStrengthOfPowerDensity_db);
      break;
    case Quantity::received_power_dbm:
      if (scenario.receivers.empty()) {
        throw Error(ErrorCode::bad_input, {scenario.file},
                    "quantity 'received_power_dbm' needs an entry under 'receivers'");
      }
      recipe.product.offset_db = 30;
      weigh([&](const Emitter& emitter) { return receivingArea_m2(emitter, scenario.receivers.front()); });
      break;
    case Quantity::snr_db:
      recipe.reduction = Reduction::maximum;
      recipe.product.scale = 2;
      weigh(echoRoot_m2_w);
      break;
    case Quantity::detection_probability:
      recipe.product.decibels = false;
      recipe.product.floor = 0;
      break;
    case Quantity::jammer_to_signal_db:
      recipe.product.scale = -1;
      break;
    case Quantity::burn_through_margin_db:
      break;
    case Quantity::emitter_count:
      recipe.reduction = Reduction::count;
      recipe.product.decibels = false;
      recipe.product.floor = 0;
      weigh([&](const Emitter&) { return dbToRatio(scenario.output.count_threshold_dbwm2); });
      break;
    case Quantity::dominant_emitter:
      recipe.reduction = Reduction::dominant;
      recipe.product.decibels = false;
      recipe.product.floor = -1;
      break;
  }
  // The beam's own power density is what the combine stage has: a look of its own and jamming are not.
  const bool is_plain =
      channel.quantity == Quantity::snr_db && scenario.output.radar_look == scenario::RadarLook::scan;
  if (!isOfRadars(channel.quantity) || is_plain) return recipe;
  for (int e : channel.emitters) {
    const Emitter& radar = scenario.emitters[e];
    recipe.radars.push_back(radarTask(channel.quantity, radar, scenario.output));
    if (channel.quantity != Quantity::detection_probability) continue;
    recipe.curves.push_back(curveOf(radar.receiver, known_curves));
    recipe.radars.back().curve = recipe.curves.back()->view();
  }
  return recipe;
}

}  // namespace emscape::emfield
