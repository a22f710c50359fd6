#include "emfield/radar/receiver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "emfield/radar/detection_losses.h"
#include "emscape/base/units.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

using scenario::Emitter;
using scenario::RadarReceiver;
using scenario::ReceiverProfile;
using scenario::ScanKind;

RadarLink radarLinkOf(const Emitter& radar) {
  const RadarReceiver& receiver = radar.receiver;
  RadarLink link;
  link.power_w = radar.power_w;
  link.frequency_hz = radar.frequency_hz;
  link.losses_db = radar.losses_db + receiver.losses_db - receiver.processing_gain_db;
  link.bandwidth_hz = receiver.bandwidth_hz;
  // After the line's losses, which is also the reference point of the echo.
  link.noise_temperature_k = systemNoiseTemperature_k(receiver.antenna_temperature_k, kReferenceTemperature_K,
                                                      receiver.losses_db, receiver.noise_figure_db) /
                             dbToRatio(receiver.losses_db);
  return link;
}

Detector detectorOf(const RadarReceiver& receiver) {
  return {swerlingOfCase(receiver.swerling), receiver.pulses, receiver.pfa};
}

double echoRoot_m2_w(const Emitter& radar) {
  // At 1 m from an isotropic antenna.
  const double snr = dbToRatio(radarSnrDb(radarLinkOf(radar), radar.receiver.target_rcs_m2, 1));
  const double density_wm2 = radar.power_w * dbToRatio(-radar.losses_db) / (4 * kPi);
  return std::sqrt(snr) / density_wm2;
}

double polarizationLossDb(const Emitter& radar, const Emitter& jammer) {
  const RadarReceiver& receiver = radar.receiver;
  return -ratioToDb(scenario::polarizationFactor(jammer.polarization,
                                                 receiver.polarization.value_or(radar.polarization),
                                                 receiver.cross_polar_isolation_db));
}

double jammingToNoise_m2_w(const Emitter& radar, const Emitter& jammer) {
  const RadarReceiver& receiver = radar.receiver;
  const RadarLink link = radarLinkOf(radar);
  JammerLink jamming;
  jamming.eirp_w = 4 * kPi * jammer.dutyCycle();  // 1 W/m2 at 1 m in its pulses
  jamming.frequency_hz = jammer.frequency_hz;
  jamming.bandwidth_hz = jammer.bandwidth_hz;
  jamming.radar_gain_dbi = radar.antenna->gain_dbi;
  jamming.polarization_loss_db = polarizationLossDb(radar, jammer);
  jamming.radar_receive_losses_db = receiver.losses_db;
  return jammingPower_w(link, jamming, 1) / noisePower_w(link.bandwidth_hz, link.noise_temperature_k);
}

double requiredProbability(const RadarReceiver& receiver) {
  return receiver.pfa < 0.5 ? 0.5 : 0.75;
}

double requiredSnrDb(const Emitter& radar) {
  const RadarReceiver& receiver = radar.receiver;
  return requiredSnrDb(detectorOf(receiver), receiver.detection, requiredProbability(receiver)) +
         detectionLosses(radar).total_db();
}

double correlationLossDb(const Emitter& radar) {
  const RadarReceiver& receiver = radar.receiver;
  if (!radar.clutter || radar.clutter->independent_samples.value_or(receiver.pulses) >= receiver.pulses)
    return 0;
  Detector detector = detectorOf(receiver);
  const double probability = requiredProbability(receiver);
  const double of_pulses_db = requiredSnrDb(detector, receiver.detection, probability);
  detector.pulses = *radar.clutter->independent_samples;
  return std::max(requiredSnrDb(detector, receiver.detection, probability) - of_pulses_db, 0.0);
}

double requiredSignalToJammerDb(const Emitter& radar) {
  const std::optional<double>& stated_db = radar.receiver.required_signal_to_jammer_db;
  return stated_db ? *stated_db : requiredSnrDb(radar);
}

double inBandArea_m2(const Emitter& emitter, const ReceiverProfile& receiver) {
  const double wavelength = wavelength_m(emitter.frequency_hz);
  const double polarization = receiver.polarization
                                  ? scenario::polarizationFactor(emitter.polarization, *receiver.polarization,
                                                                 receiver.cross_polar_isolation_db)
                                  : 1;
  return wavelength * wavelength / (4 * kPi) * dbToRatio(receiver.gain_dbi - receiver.losses_db) *
         polarization;
}

double partInBand(const Emitter& emitter, double tuned_hz, double width_hz) {
  return bandOverlap(emitter.frequency_hz, emitter.bandwidth_hz,
                     tuned_hz > 0 ? tuned_hz : emitter.frequency_hz,
                     width_hz > 0 ? width_hz : std::max(emitter.bandwidth_hz, 1.0));
}

double receivingArea_m2(const Emitter& emitter, const ReceiverProfile& receiver) {
  return inBandArea_m2(emitter, receiver) *
         partInBand(emitter, receiver.center_frequency_hz, receiver.bandwidth_hz);
}

std::shared_ptr<const DetectionCurve> detectionCurveOf(const Emitter& radar) {
  static std::mutex mutex;
  static std::vector<std::weak_ptr<const DetectionCurve>> known;
  const Detector detector = detectorOf(radar.receiver);
  const scenario::DetectionMethod method = radar.receiver.detection;
  const double loss_db = detectionLosses(radar).total_db();
  const bool blanks = radar.receiver.side_lobe_blanking.has_value();
  const std::lock_guard lock(mutex);
  known.erase(std::remove_if(known.begin(), known.end(), [](const auto& curve) { return curve.expired(); }),
              known.end());
  for (const auto& held : known) {
    const std::shared_ptr<const DetectionCurve> curve = held.lock();
    if (curve && curve->isOf(detector, method, loss_db, blanks)) return curve;
  }
  auto curve = std::make_shared<const DetectionCurve>(detector, method, loss_db, blanks);
  known.push_back(curve);
  return curve;
}

double receiverNoise_w(const ReceiverProfile& receiver) {
  const double at_antenna_k =
      systemNoiseTemperature_k(receiver.antenna_temperature_k, kReferenceTemperature_K, receiver.losses_db,
                               receiver.noise_figure_db.value_or(0));
  return noisePower_w(receiver.bandwidth_hz, at_antenna_k / dbToRatio(receiver.losses_db));
}

double interceptThreshold_w(const ReceiverProfile& receiver) {
  double threshold_w = 0;
  if (receiver.sensitivity_dbm) threshold_w = dbToRatio(*receiver.sensitivity_dbm - 30);
  if (receiver.required_sinr_db && receiver.hasNoise())
    threshold_w = std::max(threshold_w, receiverNoise_w(receiver) * dbToRatio(*receiver.required_sinr_db));
  return threshold_w;
}

RadarLook lookOf(const Emitter& radar, scenario::RadarAim look) {
  const scenario::ScanSpec& scan = radar.scan;
  RadarLook result;
  if (look == scenario::RadarAim::scan) return result;
  if (scenario::isSteered(radar)) {
    result.kind = LookKind::steered;
    return result;
  }
  if (scan.kind == ScanKind::fixed) return result;  // held
  result.kind = LookKind::turned;
  const bool sweeps = scan.kind == ScanKind::sector || scan.kind == ScanKind::raster;
  if (sweeps && scan.width_deg < 360) {
    result.cos_azimuth = static_cast<float>(std::cos(degToRad(scan.width_deg / 2)));
    result.sin_azimuth = static_cast<float>(std::sin(degToRad(scan.width_deg / 2)));
  }
  if (sweeps || scan.kind == ScanKind::rotate) {
    const double half_deg =
        scan.kind == ScanKind::raster ? (scan.bars - 1) / 2.0 * scan.elevation_step_deg : 0;
    const double lowest_rad = degToRad(scan.elevation_deg - half_deg);
    const double highest_rad = degToRad(scan.elevation_deg + half_deg);
    result.sin_lowest = static_cast<float>(std::sin(lowest_rad));
    result.cos_lowest = static_cast<float>(std::cos(lowest_rad));
    result.sin_highest = static_cast<float>(std::sin(highest_rad));
    result.cos_highest = static_cast<float>(std::cos(highest_rad));
  }
  return result;
}

std::string targetText(const scenario::Scenario& scenario) {
  double min_m2 = HUGE_VAL, max_m2 = 0;
  for (const scenario::Emitter& emitter : scenario.emitters) {
    if (!emitter.enabled || emitter.kind != scenario::EmitterKind::radar) continue;
    min_m2 = std::min(min_m2, emitter.receiver.target_rcs_m2);
    max_m2 = std::max(max_m2, emitter.receiver.target_rcs_m2);
  }
  const auto isOther = [&](const scenario::Target& target) {
    return target.table != nullptr || target.rcs_m2 != min_m2 || target.rcs_m2 != max_m2;
  };
  const auto other = std::find_if(scenario.targets.begin(), scenario.targets.end(), isOther);
  if (max_m2 == 0 || other == scenario.targets.end()) return "";
  const std::string rcs_m2 =
      min_m2 == max_m2 ? fmt::format("{:g}", max_m2) : fmt::format("{:g} to {:g}", min_m2, max_m2);
  return fmt::format(
      "{} m2 ('target_rcs_m2' of each radar); '{}' of 'targets' has another, for link and exposure", rcs_m2,
      other->name);
}

}  // namespace emscape::emfield
