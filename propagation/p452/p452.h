/// Model `p452`: interference paths over terrain between 100 MHz and 50 GHz in clear air, for percentages of
/// time, ITU-R P.452-18. propagation/clear_air has the parts in common with P.1812.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/clear_air/loss.h"
#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kP452Frequency{"frequency", "GHz", 1e9, 0.1, 50, Beyond::warned, ""};
constexpr ModelLimit kP452Distance{"distance", "km", 1000, 0, 10000, Beyond::warned, ""};
constexpr ModelLimit kP452Time{"percentage of time", "%", 1, 0.001, 50, Beyond::refused, ""};
constexpr const ModelLimit* kP452Limits[] = {&kP452Frequency, &kP452Distance, &kClearAirHeight, &kP452Time,
                                             &kClearAirLapseRate};

/// Min distance of clutter from either antenna (m): P.452-18 section 3.2.1, step 4.
constexpr double kP452ClutterDistance_m = 50;

/// Within this distance along the ground (m) the loss is at least that of the line of sight.
constexpr double kP452ScatterDistance_m = 250;

/// Water vapour along paths over land, and its increase over sea (g/m3): P.452-18 eq. (9a).
constexpr double kP452LandVapour_g_m3 = 7.5, kP452SeaVapour_g_m3 = 2.5;

/// The model at one frequency, as plain data.
template <class Real>
struct P452Model {
  ClearAirModel<Real> clear_air;
  Real sea_level_refractivity = 301;  ///< N_0 (N-units)
  /// Specific attenuation by gases (dB/km) over land, over land and sea in equal parts, and over sea.
  Real gases_db_per_km[3] = {};
  Real scatter_gases_db_per_km = 0;  ///< along the higher rays of troposcatter
  Real coupling_db = 0;              ///< L_c: between antennas and the medium that scatters

  /// Specific attenuation along a path; the vapour increases with the sea fraction. A parabola through the
  /// three values.
  EMSCAPE_HD Real gasesOver(Real sea_fraction) const {
    const Real* const g = gases_db_per_km;
    return g[0] + sea_fraction * (4 * g[1] - 3 * g[0] - g[2] + sea_fraction * 2 * (g[0] - 2 * g[1] + g[2]));
  }
  /// Loss (dB) of a path relative to free space.
  /// @param rx_msl_m  of the antenna; see p452Path
  EMSCAPE_HD Real excessDb(const ClearAirColumn<Real>& column, Real rx_msl_m) const;
};

struct P452Parameters {
  ClearAirParameters clear_air;
  double sea_level_refractivity = 301;  ///< N_0 (N-units)
  double dry_pressure_hpa = 1013.25;    ///< of the dry air alone
  double temperature_k = 288.15;
  double gains_dbi = 0;  ///< sum of both antennas' gains toward their horizons
};

/// @see P.452-18 eq. (9), (9a), (45b)
/// @tparam Real  double or float
template <class Real>
P452Model<Real> p452Model(const P452Parameters& parameters);

/// L_bs: basic transmission loss (dB) by troposcatter.
/// @see P.452-18 eq. (45), (45a)
template <class Real>
EMSCAPE_HD Real p452TroposcatterDb(const P452Model<Real>& model, Real distance_m, Real angle_mrad) {
  const Real d_km = distance_m / 1000;
  const Real log_f = std::log10(model.clear_air.frequency_ghz), half = log_f - Real(0.30102999566);
  return 190 + 25 * log_f - Real(2.5) * half * half + 20 * std::log10(d_km) + Real(0.573) * angle_mrad -
         Real(0.15) * model.sea_level_refractivity + model.coupling_db +
         model.scatter_gases_db_per_km * d_km -
         Real(10.1) * std::pow(std::log10(50 / model.clear_air.time_percent), Real(0.7));
}

/// One path and the parts of its loss.
template <class Real>
struct P452Path {
  ClearAirPath<Real> geometry;
  ClearAirLoss<Real> loss;
};

/// @param rx_msl_m  of the antenna; at least 1 m above the ground
/// @see P.452-18 section 4.5
template <class Real>
EMSCAPE_HD P452Path<Real> p452Path(const P452Model<Real>& model, const ClearAirColumn<Real>& column,
                                   Real rx_msl_m) {
  P452Path<Real> path;
  path.geometry = clearAirPath(model.clear_air, column, rx_msl_m);
  ClearAirTerms<Real> terms;
  terms.gases_db_per_km = model.gasesOver(Real(column.zones.sea_fraction));
  terms.troposcatter_db = p452TroposcatterDb(model, column.distance_m, path.geometry.angle_mrad);
  // S_tim - S_tr, over the bare terrain: eq. (14), (15), (58)
  terms.obstruction_mrad =
      1000 * (column.horizon_slope + model.clear_air.median.half_curvature * column.distance_m -
              path.geometry.slope);
  path.loss = clearAirLoss(model.clear_air, column, path.geometry, terms);
  // Troposcatter depends on the distance along the ground only: above an antenna it would have no loss.
  if (column.distance_m < Real(kP452ScatterDistance_m) && path.loss.loss_db < path.loss.sight.loss_db) {
    path.loss.loss_db = path.loss.sight.loss_db;
  }
  return path;
}

template <class Real>
EMSCAPE_HD Real P452Model<Real>::excessDb(const ClearAirColumn<Real>& column, Real rx_msl_m) const {
  const ClearAirLoss<Real> loss = p452Path(*this, column, rx_msl_m).loss;
  return loss.loss_db - loss.sight.free_space_db;
}

}  // namespace emscape::propagation
