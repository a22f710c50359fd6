#include "emfield/products.h"

#include <cmath>

#include "emfield/radar/detection_losses.h"
#include "emfield/radar/receiver.h"
#include "emfield/radar_clutter.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::Quantity;

/// True for quantities of an echo behind the radar's filter, against clutter.
bool isAgainstClutter(Quantity quantity) {
  return quantity == Quantity::detection_probability || quantity == Quantity::sclnr_db;
}

/// The task of a radar in a channel of a radar quantity, without the look.
RadarTask radarTask(Quantity quantity, const Emitter& radar, const scenario::Scenario& scenario) {
  const scenario::OutputSpec& output = scenario.output;
  RadarTask task;
  task.echo_root = static_cast<float>(echoRoot_m2_w(radar));
  if (radar.clutter && isAgainstClutter(quantity)) {
    task.echo_root = static_cast<float>(echoRoot_m2_w(radar) * std::sqrt(filterResponse(radar)));
    task.clutter = clutterTask(scenario, radar);
  }
  const bool looks_at_scan = quantity == Quantity::snr_db || isAgainstClutter(quantity);
  const bool is_instant = output.interval.kind == scenario::IntervalKind::instant;
  task.look = lookOf(radar, looks_at_scan && is_instant ? output.radar_look : scenario::RadarLook::target);
  task.is_cumulative = output.interval.kind == scenario::IntervalKind::cumulative;
  const double processing = dbToRatio(radar.receiver.processing_gain_db);
  switch (quantity) {
    case Quantity::detection_probability:
      task.measure = RadarMeasure::detection;
      task.reduction = output.combine == scenario::CombineMode::max ? Reduction::maximum : Reduction::sum;
      break;
    case Quantity::jammer_to_signal_db:
      task.measure = RadarMeasure::signal_to_jamming;
      task.factor = static_cast<float>(1 / processing);
      task.lowest = 1 / kMaxJammerToSignal;
      break;
    case Quantity::burn_through_margin_db:
      task.measure = RadarMeasure::signal_to_jamming;
      task.factor = static_cast<float>(dbToRatio(-requiredSignalToJammerDb(radar)));
      task.lowest = 1 / kMaxMargin;
      task.ceiling = kMaxMargin;
      break;
    case Quantity::sclnr_db:
      task.measure = RadarMeasure::root_of_signal_to_clutter_and_noise;
      break;
    default:
      break;
  }
  return task;
}

std::shared_ptr<const DetectionCurve> curveOf(
    const Emitter& radar, const std::vector<std::shared_ptr<const DetectionCurve>>& known_curves) {
  const Detector detector = detectorOf(radar.receiver);
  const scenario::DetectionMethod method = radar.receiver.detection;
  const double loss_db = detectionLosses(radar).total_db();
  for (const auto& curve : known_curves) {
    if (curve->isOf(detector, method, loss_db)) return curve;
  }
  return std::make_shared<const DetectionCurve>(detector, method, loss_db);
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

const char* legendNoteOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::jammer_to_signal_db:
      return "no echo: 100";
    case Quantity::burn_through_margin_db:
      return "no echo: -60";
    default:
      return nullptr;
  }
}

ChannelPlan channelPlan(const Channel& channel, const scenario::Scenario& scenario,
                        const std::vector<std::shared_ptr<const DetectionCurve>>& known_curves) {
  ChannelPlan plan;
  plan.product.floor = static_cast<float>(scenario.output.floor);
  if (scenario.output.combine == scenario::CombineMode::max) plan.reduction = Reduction::maximum;
  plan.weights.assign(channel.emitters.size(), 1.0f);
  const auto weigh = [&](auto weightOf) {
    for (std::size_t i = 0; i < channel.emitters.size(); ++i) {
      plan.weights[i] = static_cast<float>(weightOf(scenario.emitters[channel.emitters[i]]));
    }
  };
  switch (channel.quantity) {
    case Quantity::power_density_dbwm2:
      break;
    case Quantity::field_strength_dbuvm:
      plan.product.offset_db = static_cast<float>(kFieldStrengthOfPowerDensity_db);
      break;
    case Quantity::received_power_dbm:
      if (scenario.receivers.empty()) {
        throw Error(ErrorCode::bad_input, {scenario.file},
                    "quantity 'received_power_dbm' needs an entry under 'receivers'");
      }
      plan.product.offset_db = 30;
      weigh([&](const Emitter& emitter) { return receivingArea_m2(emitter, scenario.receivers.front()); });
      break;
    case Quantity::snr_db:
    case Quantity::sclnr_db:
      plan.reduction = Reduction::maximum;
      plan.product.scale = 2;
      weigh(echoRoot_m2_w);
      break;
    case Quantity::detection_probability:
      plan.product.decibels = false;
      plan.product.floor = 0;
      break;
    case Quantity::jammer_to_signal_db:
      plan.product.scale = -1;
      break;
    case Quantity::burn_through_margin_db:
      break;
    case Quantity::emitter_count:
      plan.reduction = Reduction::count;
      plan.product.decibels = false;
      plan.product.floor = 0;
      weigh([&](const Emitter&) { return dbToRatio(scenario.output.count_threshold_dbwm2); });
      break;
    case Quantity::dominant_emitter:
      plan.reduction = Reduction::dominant;
      plan.product.decibels = false;
      plan.product.floor = -1;
      break;
    case Quantity::mean_power_density_dbwm2:
      weigh([](const Emitter& emitter) { return emitter.dutyCycle(); });
      break;
  }
  // The combine stage has the power density of the beam's own direction, but not that of another look, and no
  // jamming.
  const bool is_plain = channel.quantity == Quantity::snr_db &&
                        scenario.output.radar_look == scenario::RadarLook::scan &&
                        scenario.output.interval.kind == scenario::IntervalKind::instant;
  if (!needsRadar(channel.quantity) || is_plain) return plan;
  for (int e : channel.emitters) {
    const Emitter& radar = scenario.emitters[e];
    plan.radars.push_back(radarTask(channel.quantity, radar, scenario));
    if (channel.quantity != Quantity::detection_probability) continue;
    plan.curves.push_back(curveOf(radar, known_curves));
    plan.radars.back().curve = plan.curves.back()->view();
  }
  return plan;
}

}  // namespace emscape::emfield
