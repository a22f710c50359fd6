#include "emscape/emfield/quantities.h"

#include "emscape/base/error.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::emfield {

const std::vector<QuantityInfo>& quantityTable() {
  static const std::vector<QuantityInfo> kTable{
      {Quantity::power_density_dbwm2, "power_density_dbwm2", "dBW/m2", "radiated power density", false},
      {Quantity::field_strength_dbuvm, "field_strength_dbuvm", "dBuV/m", "RMS electric field strength",
       false},
      {Quantity::received_power_dbm, "received_power_dbm", "dBm", "power at the scenario's first receiver",
       false},
      {Quantity::snr_db, "snr_db", "dB", "single-pulse signal-to-noise of the best radar for its target",
       false},
      {Quantity::detection_probability, "detection_probability", "",
       "probability that the radars detect their target, jamming included", false, volume::kProbabilityScale},
      {Quantity::jammer_to_signal_db, "jammer_to_signal_db", "dB",
       "jamming over the target's echo at the receiver of the radar that bears it best", false,
       volume::kRatioBelowScale},
      {Quantity::burn_through_margin_db, "burn_through_margin_db", "dB",
       "how far the echo exceeds what burning through the jamming takes; 60 dB at most", false,
       volume::kRatioAboveScale},
      {Quantity::emitter_count, "emitter_count", "", "emitters above the count threshold", false},
      {Quantity::dominant_emitter, "dominant_emitter", "",
       "index of the emitter with the largest power density", true},
  };
  return kTable;
}

const QuantityInfo& info(Quantity quantity) {
  return quantityTable()[static_cast<std::size_t>(quantity)];
}

bool isOfRadars(Quantity quantity) {
  return quantity == Quantity::snr_db || isOfJamming(quantity);
}

bool isOfJamming(Quantity quantity) {
  return quantity == Quantity::detection_probability || quantity == Quantity::jammer_to_signal_db ||
         quantity == Quantity::burn_through_margin_db;
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
  throw Error(ErrorCode::bad_input, "unknown quantity '" + name + "'; one of " + quantityNames());
}

}  // namespace emscape::emfield
