/// Free-space loss, with focusing and multipath in line of sight: ITU-R P.1812-8 section 4.2, P.452-18
/// section 4.1.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/clear_air/path.h"

namespace emscape::propagation {

/// Basic transmission losses (dB).
template <class Real>
struct ClearAirSight {
  Real free_space_db = 0;  ///< L_bfs, without gases
  Real median_db = 0;      ///< L_bfs, with gases: L_bfsg
  Real loss_db = 0;        ///< L_b0p: not exceeded in p of the time
  Real ducting_db = 0;     ///< L_b0beta: not exceeded in beta_0 of the time
};

/// @param gases_db_per_km  along the path
/// @see P.1812-8 eq. (8) to (11); P.452-18 eq. (8) to (12)
template <class Real>
EMSCAPE_HD ClearAirSight<Real> clearAirSight(const ClearAirModel<Real>& model,
                                             const ClearAirColumn<Real>& column,
                                             const ClearAirPath<Real>& path, Real gases_db_per_km) {
  const Real d_km = column.distance_m / 1000, rise_km = (path.rx_m - column.tx_m) / 1000;
  const Real length_km = std::sqrt(d_km * d_km + rise_km * rise_km);
  const Real horizons_km = (path.horizon_distance_m[0] + path.horizon_distance_m[1]) / 1000;
  const Real focusing_db = Real(2.6) * (1 - std::exp(Real(-0.1) * horizons_km));
  ClearAirSight<Real> sight;
  sight.free_space_db = Real(92.4) + 20 * std::log10(model.frequency_ghz) + 20 * std::log10(length_km);
  sight.median_db = sight.free_space_db + gases_db_per_km * length_km;
  sight.loss_db = sight.median_db + focusing_db * std::log10(model.time_percent / 50);
  sight.ducting_db = sight.median_db + focusing_db * std::log10(column.ducting_time_percent / 50);
  return sight;
}

}  // namespace emscape::propagation
