#include "emscape/scenario/model/quantities.h"

#include "emscape/base/error.h"

namespace emscape::scenario {

const std::vector<QuantityInfo>& quantityTable() {
  static const std::vector<QuantityInfo> kTable{
      {Quantity::power_density_dbwm2, "power_density_dbwm2", "dBW/m2", QuantityKind::of_emitters,
       "radiated power density"},
      {Quantity::field_strength_dbuvm, "field_strength_dbuvm", "dBuV/m", QuantityKind::of_emitters,
       "RMS electric field strength"},
      {Quantity::received_power_dbm, "received_power_dbm", "dBm", QuantityKind::of_receiver,
       "power received by a given antenna"},
      {Quantity::snr_db, "snr_db", "dB", QuantityKind::of_radars,
       "best radar's single-pulse signal-to-noise ratio for a target of given cross-section"},
      {Quantity::detection_probability, "detection_probability", "", QuantityKind::of_jamming,
       "probability that the radars detect their target, jamming included"},
      {Quantity::jammer_to_signal_db, "jammer_to_signal_db", "dB", QuantityKind::of_jamming,
       "jamming over the target's echo, at the radar with the lowest J/S", false, true},
      {Quantity::burn_through_margin_db, "burn_through_margin_db", "dB", QuantityKind::of_jamming,
       "echo above the level needed for burn-through; at most 60 dB", false, true},
      {Quantity::emitter_count, "emitter_count", "", QuantityKind::of_emitters,
       "emitters above the count threshold"},
      {Quantity::dominant_emitter, "dominant_emitter", "", QuantityKind::of_emitters,
       "index of the emitter with the largest power density", true},
      {Quantity::mean_power_density_dbwm2, "mean_power_density_dbwm2", "dBW/m2", QuantityKind::of_emitters,
       "power density averaged over the radars' pulses and pauses; over an interval of kind mean also over "
       "their scans"},
      {Quantity::sclnr_db, "sclnr_db", "dB", QuantityKind::of_radars,
       "best radar's single-pulse echo over noise and the clutter of land, sea and rain, after its Doppler "
       "filter"},
      {Quantity::sinr_db, "sinr_db", "dB", QuantityKind::of_receiver,
       "wanted emitter's power at a receiver, over noise and all other emitters in its band"},
      {Quantity::intercept_margin_db, "intercept_margin_db", "dB", QuantityKind::of_receiver,
       "largest power of an emitter at a receiver, over its threshold"},
      {Quantity::detection_age_s, "detection_age_s", "s", QuantityKind::of_jamming,
       "time since a radar last detected its target, at the end of the interval"},
      {Quantity::occupancy, "occupancy", "", QuantityKind::of_emitters,
       "share of the interval in which an emitter's power density is above the count threshold"},
      {Quantity::dominant_model, "dominant_model", "", QuantityKind::of_emitters,
       "model, or part of one, that determines the loss of the emitter with the largest power density", true},
      {Quantity::exposure_ratio, "exposure_ratio", "", QuantityKind::of_emitters,
       "sum over the emitters of mean power density over ICNIRP's reference level for the exposure of "
       "people"},
  };
  return kTable;
}

const QuantityInfo& info(Quantity quantity) {
  return quantityTable()[static_cast<std::size_t>(quantity)];
}

bool hasInterval(const QuantityInfo& quantity, IntervalKind interval) {
  if (quantity.quantity == Quantity::detection_age_s) return interval == IntervalKind::cumulative;
  if (quantity.quantity == Quantity::occupancy) return interval == IntervalKind::mean;
  switch (interval) {
    case IntervalKind::instant:
      return true;
    case IntervalKind::max_hold:  // the largest ratio is not the ratio of the largest parts, which change
                                  // independently
      return !quantity.needs_jammer && quantity.quantity != Quantity::sinr_db;
    case IntervalKind::mean:
      return quantity.quantity == Quantity::power_density_dbwm2 ||
             quantity.quantity == Quantity::mean_power_density_dbwm2 ||
             quantity.quantity == Quantity::field_strength_dbuvm ||
             quantity.quantity == Quantity::exposure_ratio ||
             quantity.quantity == Quantity::received_power_dbm;
    case IntervalKind::cumulative:
      break;
  }
  return quantity.quantity == Quantity::detection_probability;
}

bool needsRadar(Quantity quantity) {
  return info(quantity).kind == QuantityKind::of_radars || needsJammer(quantity);
}

bool needsJammer(Quantity quantity) {
  return info(quantity).kind == QuantityKind::of_jamming;
}

std::string quantityNames() {
  std::string names;
  for (const QuantityInfo& entry : quantityTable()) {
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return names;
}

Quantity quantityFromName(const std::string& name) {
  for (const QuantityInfo& entry : quantityTable()) {
    if (name == entry.name) return entry.quantity;
  }
  throw Error(ErrorCode::usage, "unknown quantity '" + name + "'; one of " + quantityNames());
}

}  // namespace emscape::scenario
