/// Loss by trees and buildings around the ends of terrestrial paths, for a percentage of locations: ITU-R
/// P.2108-1, section 3.2. A statistic of urban and suburban surroundings, where no map is known.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kP2108Frequency{
    "frequency", "GHz", 1e9, 0.5, 67, Beyond::warned, "outside, no terminal clutter is added"};
constexpr ModelLimit kP2108Location{"percentage of locations", "%", 1, 0.1, 99.9, Beyond::refused,
                                    "0 and 100 have no value"};
constexpr const ModelLimit* kP2108Limits[] = {&kP2108Frequency, &kP2108Location};

/// Shortest paths (m) with the loss at one end, and at both.
constexpr float kP2108OneEnd_m = 250, kP2108BothEnds_m = 1000;

namespace p2108_detail {

/// @see eq. (3) to (5)
template <class Real>
EMSCAPE_HD Real lossDb(Real frequency_ghz, Real distance_km, Real deviate) {
  const Real ten = 10, log_f = std::log10(frequency_ghz);
  const Real far_db = -2 * std::log10(std::pow(ten, -5 * log_f - Real(12.5)) + std::pow(ten, Real(-16.5)));
  const Real near_db = Real(32.98) + Real(23.9) * std::log10(distance_km) + 3 * log_f;
  const Real far_part = std::pow(ten, Real(-0.2) * far_db), near_part = std::pow(ten, Real(-0.2) * near_db);
  const Real both = far_part + near_part;
  const Real deviation_db = std::sqrt((16 * far_part + 36 * near_part) / both);
  return -5 * std::log10(both) + deviation_db * deviate;
}

}  // namespace p2108_detail

/// L_ctt: loss (dB) at one end that is not exceeded in a percentage of locations; at most that at 2 km.
/// @param deviate  standard normal deviate of the percentage: 0 for half of the locations
/// @see eq. (3) to (6)
template <class Real>
EMSCAPE_HD Real p2108LossDb(Real frequency_ghz, Real distance_m, Real deviate) {
  const Real farthest_db = p2108_detail::lossDb(frequency_ghz, Real(2), deviate);
  if (!(distance_m < 2000)) return farthest_db;
  const Real loss_db = p2108_detail::lossDb(frequency_ghz, distance_m / 1000, deviate);
  return loss_db < farthest_db ? loss_db : farthest_db;
}

/// The loss of an emitter's paths at their ends, as plain data.
struct TerminalClutter {
  float frequency_ghz = 0;  ///< 0: none
  float deviate = 0;
  float below_m = 0;            ///< height above the ground up to which an end is within the clutter
  bool at_transmitter = false;  ///< the emitter's end is
  bool is_larger = false;       ///< of this loss and the model's excess, the larger counts, not the sum

  EMSCAPE_HD bool isSet() const { return frequency_ghz > 0; }

  /// Number of ends with a loss.
  EMSCAPE_HD int ends(float distance_m, float height_agl_m) const {
    if (!isSet() || !(distance_m >= kP2108OneEnd_m)) return 0;
    const int ends = (height_agl_m <= below_m ? 1 : 0) + (at_transmitter ? 1 : 0);
    return ends > 1 && distance_m < kP2108BothEnds_m ? 1 : ends;
  }
  /// @param height_agl_m  of the path's far end
  EMSCAPE_HD float lossDb(float distance_m, float height_agl_m) const {
    const int count = ends(distance_m, height_agl_m);
    if (count == 0) return 0;
    return float(count) * p2108LossDb(frequency_ghz, distance_m, deviate);
  }
  /// A model's excess loss (dB, NaN: unknown), without that of the air, with this loss.
  EMSCAPE_HD float withLossDb(float excess_db, float distance_m, float height_agl_m) const {
    const float loss_db = lossDb(distance_m, height_agl_m);
    if (!is_larger || loss_db == 0) return excess_db + loss_db;
    return loss_db > excess_db ? loss_db : excess_db;
  }
};

}  // namespace emscape::propagation
