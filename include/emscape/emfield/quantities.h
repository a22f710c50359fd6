/// The quantities that the pipeline can produce.
#pragma once

#include <string>
#include <vector>

namespace emscape::emfield {

enum class Quantity {
  power_density_dbwm2,
  field_strength_dbuvm,
  received_power_dbm,
  snr_db,
  detection_probability,
  jammer_to_signal_db,
  burn_through_margin_db,
  emitter_count,
  dominant_emitter,
};

struct QuantityInfo {
  Quantity quantity;
  const char* name;             ///< as in scenario files and volumes
  const char* unit;             ///< for colour bars; empty for counts and indices
  const char* description;      ///< one line
  bool categorical;             ///< indices: nearest sampling, integer grids
  const char* scale = nullptr;  ///< as volume::kScaleKey has it; null: none
};

/// Quantities of radars and their targets; the other emitters do not enter.
bool isOfRadars(Quantity quantity);
/// Those of them in which jamming counts.
bool isOfJamming(Quantity quantity);

/// All quantities, in the order of the enum.
const std::vector<QuantityInfo>& quantityTable();
const QuantityInfo& info(Quantity quantity);
/// The names of all, with commas between them.
std::string quantityNames();
/// @throws Error (bad_input) that lists the allowed names
Quantity quantityFromName(const std::string& name);

}  // namespace emscape::emfield
