/// The quantities: requested by scenarios, computed by emfield and stored in volumes.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/model/interval.h"

namespace emscape::scenario {

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
  mean_power_density_dbwm2,
  sclnr_db,
  sinr_db,
  intercept_margin_db,
  detection_age_s,
  occupancy,
  dominant_model,
  exposure_ratio,
};

/// Signals on which a quantity depends.
enum class QuantityKind {
  of_emitters,
  of_receiver,  ///< all emitters, at one of the scenario's receivers
  of_radars,    ///< radars and their targets; no other emitters
  of_jamming    ///< radars, their targets and jammers
};

struct QuantityInfo {
  Quantity quantity;
  const char* name;  ///< in scenario files and volumes
  const char* unit;  ///< for colour bars; empty for counts and indices
  QuantityKind kind;
  const char* description;    ///< one line
  bool categorical = false;   ///< indices: nearest sampling, integer grids
  bool needs_jammer = false;  ///< the scenario must have a jammer
};

/// True if a quantity is defined for such an interval.
bool hasInterval(const QuantityInfo& quantity, IntervalKind interval);
/// True for quantities of radars and their targets, with or without jamming.
bool needsRadar(Quantity quantity);
/// True for quantities that depend on jamming.
bool needsJammer(Quantity quantity);

/// The people for whom levels of exposure to radio waves hold.
enum class ExposureGroup { general_public, occupational };
constexpr auto namesOf(ExposureGroup) {
  return std::array{"general_public", "occupational"};
}

/// Reference level of the incident power density (W/m2) of a plane wave, averaged over the whole body and
/// over 30 minutes. Below 30 MHz the levels are those of the electric and the magnetic field, of which the
/// plane wave that reaches the first of them is taken.
/// @param frequency_hz  without a level outside 100 kHz .. 300 GHz
/// @see ICNIRP, Guidelines for Limiting Exposure to Electromagnetic Fields (100 kHz to 300 GHz), Health
/// Physics 118 (2020), table 5
std::optional<double> referenceLevel_wm2(ExposureGroup group, double frequency_hz);

/// All quantities, in the order of the enum.
const std::vector<QuantityInfo>& quantityTable();
const QuantityInfo& info(Quantity quantity);
/// The names of all quantities, separated by commas.
std::string quantityNames();
/// @throws Error (usage) that lists the allowed names
Quantity quantityFromName(const std::string& name);

}  // namespace emscape::scenario
