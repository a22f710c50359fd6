#include "emfield/channels/products.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emfield/channels/radar_clutter.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/volume/dense_volume.h"
#include "propagation/mechanism.h"
#include "scenario/file/quantity_needs.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::Quantity;

/// True for quantities of an echo after the radar's filter, against clutter.
bool isAgainstClutter(Quantity quantity) {
  return quantity == Quantity::detection_probability || quantity == Quantity::detection_age_s ||
         quantity == Quantity::sclnr_db;
}

/// The ranges in which a radar can detect.
HeardRanges heardRanges(const scenario::Waveform& waveform) {
  HeardRanges heard;
  heard.farthest_m = static_cast<float>(waveform.farthestDetection_m());
  heard.repeat_m = static_cast<float>(waveform.unambiguousRange_m());
  heard.pulse_m = static_cast<float>(waveform.minRange_m());
  return heard;
}

/// The echo over its mean that a target exceeds in a part of the looks.
double echoExceeded(double part, Swerling swerling) {
  if (swerling == Swerling::slow_exponential || swerling == Swerling::fast_exponential)
    return -std::log(part);
  double low = 0, high = 50;  // (1 + 2 x) exp(-2 x) = part
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    ((1 + 2 * middle) * std::exp(-2 * middle) > part ? low : high) = middle;
  }
  return low;
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
  task.look = lookOf(radar, looks_at_scan && is_instant ? output.radar_look : scenario::RadarAim::target);
  task.is_cumulative = output.interval.kind == scenario::IntervalKind::cumulative;
  const double processing = dbToRatio(radar.receiver.processing_gain_db);
  const bool is_detection =
      quantity == Quantity::detection_probability || quantity == Quantity::detection_age_s;
  if (is_detection && radar.waveform && radar.waveform->limits_detection)
    task.heard = heardRanges(*radar.waveform);
  if (is_detection && radar.clutter) {
    const auto weight = static_cast<float>(dbToRatio(correlationLossDb(radar)));
    task.clutter.surface *= weight;
    task.clutter.rain *= weight;
  }
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
      task.ceiling = task.unjammed = kMaxMargin;
      break;
    case Quantity::sclnr_db:
      task.measure = RadarMeasure::root_of_signal_to_clutter_and_noise;
      break;
    case Quantity::detection_age_s:
      task.measure = RadarMeasure::detection_age;
      task.lowest = static_cast<float>(output.detection_threshold);
      break;
    default:
      break;
  }
  return task;
}

/// Upper bound (s) of the age of any detection in the intervals of a channel's radars.
double longestAge_s(const Channel& channel, const scenario::Scenario& scenario) {
  double longest_s = 0;
  for (const int e : channel.emitters) {
    const double duration_s =
        scenario::intervalDuration_s(scenario.output.interval, scenario.emitters[e].scan, scenario.clock);
    longest_s = std::max(longest_s, duration_s);
  }
  return 2 * longest_s;
}

/// The receiver of the output, tuned to the wanted emitter unless it has a frequency of its own.
scenario::ReceiverProfile tunedToWanted(const scenario::Scenario& scenario) {
  scenario::ReceiverProfile receiver = scenario.receivers[scenario.output.receiver];
  if (receiver.center_frequency_hz == 0)
    receiver.center_frequency_hz = scenario.emitters[scenario.output.wanted_emitter].frequency_hz;
  return receiver;
}

}  // namespace

const char* scaleOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::detection_probability:
    case Quantity::occupancy:
    case Quantity::exposure_ratio:
      return volume::kProbabilityScale;
    case Quantity::jammer_to_signal_db:
      return volume::kRatioBelowScale;
    case Quantity::burn_through_margin_db:
    case Quantity::intercept_margin_db:
      return volume::kRatioAboveScale;
    default:
      return nullptr;
  }
}

bool emittersOnlyRaise(Quantity quantity) {
  switch (quantity) {
    case Quantity::power_density_dbwm2:
    case Quantity::mean_power_density_dbwm2:
    case Quantity::field_strength_dbuvm:
    case Quantity::received_power_dbm:
    case Quantity::intercept_margin_db:
    case Quantity::snr_db:
    case Quantity::sclnr_db:
    case Quantity::detection_probability:
    case Quantity::burn_through_margin_db:
    case Quantity::emitter_count:
    case Quantity::occupancy:
    case Quantity::exposure_ratio:
      return true;
    case Quantity::sinr_db:  // others interfere
    case Quantity::jammer_to_signal_db:
    case Quantity::detection_age_s:  // of the latest
    case Quantity::dominant_emitter:
    case Quantity::dominant_model:
      break;
  }
  return false;
}

std::string legendNoteOf(Quantity quantity, const scenario::Scenario& scenario) {
  switch (quantity) {
    case Quantity::jammer_to_signal_db:
      return "no echo: 100";
    case Quantity::burn_through_margin_db:
      return "no echo: -60";
    case Quantity::sinr_db:
      return "signal: " + scenario.emitters[scenario.output.wanted_emitter].name;
    case Quantity::occupancy:
      return fmt::format("above {:g} dBW/m2", scenario.output.count_threshold_dbwm2);
    case Quantity::exposure_ratio:
      return scenario.output.exposure_group == scenario::ExposureGroup::occupational
                 ? "1: ICNIRP 2020, occupational"
                 : "1: ICNIRP 2020, general public";
    case Quantity::detection_age_s:
      return fmt::format("Pd at least {:g}; not detected: empty", scenario.output.detection_threshold);
    default:
      return "";
  }
}

Blanker blankerOf(double auxiliary, const Detector& detector, const DetectionCurve& curve) {
  Blanker blanker;
  blanker.auxiliary = static_cast<float>(auxiliary);
  blanker.curve = curve.blanked();
  const double echo = dbToRatio(-curve.loss_db());
  // What is blanked of a steady echo S is a mean of exp(-p S) over rates p, of one that varies as a complex
  // Gaussian variable that of 1 / (1 + p S), of one of case 4 that of 1 / (1 + p S / 2)^2. The others by the
  // second, of complex powers: within 1.1e-4 and 7e-4.
  if (isSteadyInALook(detector)) {
    blanker.parts[0] = {{1.2387059f, -1.4792465f}, {0.4102354f, 0.3121898f}};
    blanker.parts[1] = {{-0.2387059f, -0.0769748f}, {-0.0276183f, 0.2748741f}};
  } else if (detector.swerling == Swerling::fast_dominant) {
    blanker.fluctuation = 0.5f;
    blanker.parts[0] = {{1, -20}, {0.4987531f, 0.0249377f}};
  } else {
    blanker.fluctuation = 1;
    blanker.parts[0] = {{1, 0}, {1, 0}};
  }
  if (!isSteadyInALook(detector) || detector.swerling == Swerling::steady) {
    blanker.echo_count = 1;
    blanker.echoes[0] = static_cast<float>(echo);
    blanker.weights[0] = 1;
    return blanker;
  }
  // Gauss and Legendre's, over the part of the looks.
  constexpr double kNodes[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                               0.9602898564975363};
  constexpr double kWeights[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                 0.1012285362903763};
  for (int n = 0; n < kMaxBlankedEchoes; ++n) {
    const double part = (1 + (n % 2 == 0 ? kNodes[n / 2] : -kNodes[n / 2])) / 2;
    blanker.echoes[n] = static_cast<float>(echo * echoExceeded(part, detector.swerling));
    blanker.weights[n] = static_cast<float>(kWeights[n / 2] / 2);
  }
  blanker.echo_count = kMaxBlankedEchoes;
  return blanker;
}

ChannelPlan channelPlan(const Channel& channel, const scenario::Scenario& scenario) {
  ChannelPlan plan;
  plan.product.floor = static_cast<float>(scenario.output.floor);
  if (scenario.output.combine == scenario::CombineMode::max) plan.reduction = Reduction::maximum;
  plan.weights.assign(channel.emitters.size(), 1.0f);
  const auto weigh = [&](auto weightOf) {
    for (std::size_t i = 0; i < channel.emitters.size(); ++i) {
      plan.weights[i] = static_cast<float>(weightOf(scenario.emitters[channel.emitters[i]]));
    }
  };
  const std::string unmet = scenario::unmetNeed(channel.quantity, scenario, scenario.output);
  if (!unmet.empty()) throw Error(ErrorCode::bad_input, {scenario.file}, unmet);
  switch (channel.quantity) {
    case Quantity::power_density_dbwm2:
      break;
    case Quantity::field_strength_dbuvm:
      plan.product.offset = static_cast<float>(kFieldStrengthOfPowerDensity_db);
      break;
    case Quantity::received_power_dbm:
      plan.product.offset = 30;
      weigh([&](const Emitter& emitter) {
        return receivingArea_m2(emitter, scenario.receivers[scenario.output.receiver]);
      });
      break;
    case Quantity::sinr_db: {
      plan.reduction = Reduction::signal;
      plan.product.form = ProductForm::signal_ratio;
      const scenario::ReceiverProfile receiver = tunedToWanted(scenario);
      const double noise_w = receiverNoise_w(receiver);
      const Emitter* const wanted = &scenario.emitters[scenario.output.wanted_emitter];
      weigh([&](const Emitter& emitter) {
        return (&emitter == wanted ? -1 : 1) * receivingArea_m2(emitter, receiver) / noise_w;
      });
      break;
    }
    case Quantity::intercept_margin_db: {
      plan.reduction = Reduction::maximum;
      const scenario::ReceiverProfile& receiver = scenario.receivers[scenario.output.receiver];
      const double threshold_w = interceptThreshold_w(receiver);
      weigh([&](const Emitter& emitter) { return receivingArea_m2(emitter, receiver) / threshold_w; });
      break;
    }
    case Quantity::snr_db:
    case Quantity::sclnr_db:
      plan.reduction = Reduction::maximum;
      plan.product.scale = 2;
      weigh(echoRoot_m2_w);
      break;
    case Quantity::detection_probability:
      plan.product.form = ProductForm::itself;
      plan.product.floor = 0;
      break;
    case Quantity::jammer_to_signal_db:
      plan.product.scale = -1;
      break;
    case Quantity::burn_through_margin_db:
      break;
    case Quantity::detection_age_s:
      plan.product.form = ProductForm::age;
      plan.product.offset = static_cast<float>(longestAge_s(channel, scenario));
      plan.product.floor = -1;
      break;
    case Quantity::emitter_count:
      plan.reduction = Reduction::count;
      plan.product.form = ProductForm::itself;
      plan.product.floor = 0;
      weigh([&](const Emitter&) { return dbToRatio(scenario.output.count_threshold_dbwm2); });
      break;
    case Quantity::dominant_emitter:
      plan.reduction = Reduction::dominant;
      plan.product.form = ProductForm::itself;
      plan.product.floor = -1;
      for (std::size_t i = 0; i < plan.weights.size(); ++i)
        plan.weights[i] = static_cast<float>(channel.emitters[i]);
      break;
    case Quantity::dominant_model:
      plan.reduction = Reduction::dominant_mechanism;
      plan.product.form = ProductForm::itself;
      plan.product.floor = -1;
      weigh([](const Emitter& emitter) {
        return static_cast<int>(propagation::mechanismOf(emitter.propagation.model));
      });
      break;
    case Quantity::occupancy:
      plan.product.form = ProductForm::itself;
      plan.product.floor = 0;
      plan.occupancy_threshold_wm2 = static_cast<float>(dbToRatio(scenario.output.count_threshold_dbwm2));
      break;
    case Quantity::mean_power_density_dbwm2:
      weigh([](const Emitter& emitter) { return emitter.dutyCycle(); });
      break;
    case Quantity::exposure_ratio:
      plan.product.form = ProductForm::itself;
      plan.product.floor = 0;
      weigh([&](const Emitter& emitter) {
        return emitter.dutyCycle() /
               *scenario::referenceLevel_wm2(scenario.output.exposure_group, emitter.frequency_hz);
      });
      break;
  }
  // The combine stage computes the power density for the beam's direction, but not for other looks, and no
  // jamming.
  const bool is_plain = channel.quantity == Quantity::snr_db &&
                        scenario.output.radar_look == scenario::RadarAim::scan &&
                        scenario.output.interval.kind == scenario::IntervalKind::instant;
  if (!needsRadar(channel.quantity) || is_plain) return plan;
  for (int e : channel.emitters) {
    const Emitter& radar = scenario.emitters[e];
    plan.radars.push_back(radarTask(channel.quantity, radar, scenario));
    const bool is_age = channel.quantity == Quantity::detection_age_s;
    if (is_age) plan.radars.back().ceiling = plan.product.offset;
    if (!is_age && channel.quantity != Quantity::detection_probability) continue;
    plan.curves.push_back(detectionCurveOf(radar));
    plan.radars.back().curve = plan.curves.back()->view();
    if (const auto& blanking = radar.receiver.side_lobe_blanking) {
      plan.radars.back().blanker = blankerOf(
          dbToRatio(blanking->auxiliary_gain_dbi - blanking->threshold_db - radar.antenna->gain_dbi),
          detectorOf(radar.receiver), *plan.curves.back());
    }
  }
  return plan;
}

}  // namespace emscape::emfield
