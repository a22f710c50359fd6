#include "emfield/products.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::ReceiverProfile;

/// Part of an emitter's power (0..1) that lies within a receiver's band.
double bandOverlap(const Emitter& emitter, const ReceiverProfile& receiver) {
  const double center_hz =
      receiver.center_frequency_hz > 0 ? receiver.center_frequency_hz : emitter.frequency_hz;
  const double receiver_hz =
      receiver.bandwidth_hz > 0 ? receiver.bandwidth_hz : std::max(emitter.bandwidth_hz, 1.0);
  const double begin_hz =
      std::max(center_hz - receiver_hz / 2, emitter.frequency_hz - emitter.bandwidth_hz / 2);
  const double end_hz =
      std::min(center_hz + receiver_hz / 2, emitter.frequency_hz + emitter.bandwidth_hz / 2);
  if (end_hz < begin_hz) return 0;
  return emitter.bandwidth_hz > 0 ? (end_hz - begin_hz) / emitter.bandwidth_hz : 1;
}

/// Received power (W) of a power density of 1 W/m2.
double receivingArea_m2(const Emitter& emitter, const ReceiverProfile& receiver) {
  const double wavelength = wavelength_m(emitter.frequency_hz);
  const double polarization =
      receiver.polarization ? scenario::polarizationFactor(emitter.polarization, *receiver.polarization) : 1;
  return wavelength * wavelength / (4 * kPi) * dbToRatio(receiver.gain_dbi - receiver.losses_db) *
         polarization * bandOverlap(emitter, receiver);
}

/// Root of the factor c of SNR = c S^2, with S the one-way power density at the target: the radar range
/// equation
///   SNR = P G^2 lambda^2 sigma F^4 / ((4 pi)^3 R^4 k T0 Fn B Lt Lr)
/// with P G F^2 / (4 pi R^2 Lt) = S. Factors of the path count twice with S; the pattern's too, as the radar
/// receives through it.
double snrRoot(const Emitter& radar) {
  const double wavelength = wavelength_m(radar.frequency_hz);
  const double noise_w = kBoltzmann * kReferenceTemperature_K * dbToRatio(radar.receiver.noise_figure_db) *
                         radar.receiver.bandwidth_hz;
  const double losses = dbToRatio(radar.losses_db - radar.receiver.losses_db);
  return wavelength * std::sqrt(radar.receiver.target_rcs_m2 * losses / (4 * kPi * radar.power_w * noise_w));
}

}  // namespace

ChannelRecipe recipeOf(const Channel& channel, const scenario::Scenario& scenario) {
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
      if (channel.emitters.empty()) {
        throw Error(ErrorCode::bad_input, {scenario.file},
                    "quantity 'snr_db' needs an emitter of kind 'radar'");
      }
      recipe.reduction = Reduction::maximum;
      recipe.product.scale = 2;
      weigh(snrRoot);
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
  return recipe;
}

}  // namespace emscape::emfield
