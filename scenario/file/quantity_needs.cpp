#include "scenario/file/quantity_needs.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace emscape::scenario {
namespace {

template <class T>
bool isIndexOf(const std::vector<T>& items, int index) {
  return index >= 0 && index < static_cast<int>(items.size());
}

/// True if a signal and a receiver have frequencies in common.
bool meets(const Emitter& emitter, const ReceiverProfile& receiver) {
  return receiver.center_frequency_hz == 0 || std::abs(emitter.frequency_hz - receiver.center_frequency_hz) <
                                                  (emitter.bandwidth_hz + receiver.bandwidth_hz) / 2;
}

std::string unmetOfSinr(const Scenario& scenario, const OutputSpec& output) {
  const ReceiverProfile& receiver = scenario.receivers[static_cast<std::size_t>(output.receiver)];
  if (output.interval.kind != IntervalKind::instant) return "sinr_db has no meaning over an interval";
  if (!isIndexOf(scenario.emitters, output.wanted_emitter))
    return "sinr_db needs 'wanted_emitter' in the output: the name of the emitter whose signal is received";
  if (!receiver.hasNoise()) {
    return fmt::format("sinr_db needs the noise of the receiver '{}': its noise_figure_db and bandwidth_hz",
                       receiver.name);
  }
  const Emitter& wanted = scenario.emitters[static_cast<std::size_t>(output.wanted_emitter)];
  if (meets(wanted, receiver)) return "";
  return fmt::format(
      "sinr_db: the wanted emitter '{}' ({} Hz, {} Hz wide) is outside the band of the receiver '{}' ({} Hz, "
      "{} Hz wide)",
      wanted.name, wanted.frequency_hz, wanted.bandwidth_hz, receiver.name, receiver.center_frequency_hz,
      receiver.bandwidth_hz);
}

std::string unmetOfExposure(const Scenario& scenario, const OutputSpec& output) {
  for (const Emitter& emitter : scenario.emitters) {
    if (referenceLevel_wm2(output.exposure_group, emitter.frequency_hz)) continue;
    return fmt::format(
        "exposure_ratio has reference levels from 100 kHz to 300 GHz, not at the {} Hz of the emitter '{}'",
        emitter.frequency_hz, emitter.name);
  }
  return "";
}

std::string unmetOfAge(const Scenario& scenario, const OutputSpec& output) {
  if (!hasInterval(info(Quantity::detection_age_s), output.interval.kind))
    return "detection_age_s needs an 'interval' of kind cumulative in the output";
  for (const Emitter& emitter : scenario.emitters) {
    const ScanKind scan = emitter.scan.kind;
    if (emitter.kind != EmitterKind::radar || (scan != ScanKind::raster && scan != ScanKind::dwell_list))
      continue;
    return fmt::format(
        "detection_age_s has no passes of the radar '{}': its scan is {}, not fixed, rotate, sector or track",
        emitter.name, toString(scan));
  }
  return "";
}

}  // namespace

std::string unmetInterval(Quantity quantity, IntervalKind interval) {
  if (hasInterval(info(quantity), interval)) return "";
  std::string possible;
  for (const QuantityInfo& row : quantityTable()) {
    if (hasInterval(row, interval)) possible += (possible.empty() ? "" : ", ") + std::string(row.name);
  }
  return fmt::format("{} has no meaning over an interval of kind {}; these have: {}", info(quantity).name,
                     toString(interval), possible);
}

std::string unmetNeed(Quantity quantity, const Scenario& scenario, const OutputSpec& output) {
  if (quantity == Quantity::detection_age_s) return unmetOfAge(scenario, output);
  if (quantity == Quantity::exposure_ratio) return unmetOfExposure(scenario, output);
  if (quantity == Quantity::occupancy && !hasInterval(info(quantity), output.interval.kind))
    return "occupancy needs an 'interval' of kind mean in the output";
  if (info(quantity).kind != QuantityKind::of_receiver) return "";
  if (!isIndexOf(scenario.receivers, output.receiver)) {
    return fmt::format("quantity '{}' needs an entry under 'receivers' without a platform",
                       info(quantity).name);
  }
  if (quantity == Quantity::sinr_db) return unmetOfSinr(scenario, output);
  const ReceiverProfile& receiver = scenario.receivers[static_cast<std::size_t>(output.receiver)];
  const bool has_threshold = receiver.sensitivity_dbm || (receiver.required_sinr_db && receiver.hasNoise());
  if (quantity != Quantity::intercept_margin_db || has_threshold) return "";
  return fmt::format(
      "intercept_margin_db needs a threshold of the receiver '{}': its sensitivity_dbm, or its "
      "required_sinr_db with noise_figure_db and bandwidth_hz",
      receiver.name);
}

}  // namespace emscape::scenario
