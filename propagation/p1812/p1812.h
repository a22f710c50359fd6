/// Model `p1812`: paths over terrain between 30 MHz and 6 GHz, for percentages of time and locations, ITU-R
/// P.1812-8. propagation/clear_air has the parts in common with P.452.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/clear_air/loss.h"
#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kP1812Frequency{"frequency", "MHz", 1e6, 30, 6000, Beyond::warned, ""};
constexpr ModelLimit kP1812Distance{"distance",
                                    "km",
                                    1000,
                                    0.25,
                                    3000,
                                    Beyond::warned,
                                    "nearer than that the loss goes to that of free space"};
constexpr ModelLimit kP1812Time{"percentage of time", "%", 1, 1, 50, Beyond::refused, ""};
constexpr ModelLimit kP1812Location{"percentage of locations", "%", 1, 1, 99, Beyond::refused, ""};
constexpr ModelLimit kP1812LocationWidth{
    "width of the squares of locations", "m", 1, 50, 1000, Beyond::refused, ""};
constexpr const ModelLimit* kP1812Limits[] = {&kP1812Frequency,   &kP1812Distance, &kClearAirHeight,
                                              &kP1812Time,        &kP1812Location, &kP1812LocationWidth,
                                              &kClearAirLapseRate};

/// The model at one frequency, as plain data.
template <class Real>
struct P1812Model {
  ClearAirModel<Real> clear_air;
  Real sea_level_refractivity = 301;  ///< N_0 (N-units)
  Real location_deviation_db = 0;     ///< sigma_L at and below the height of the clutter
  Real location_deviate = 0;          ///< standard normal deviate of the percentage of locations; 0: median
  Real clutter_height_m = 0;          ///< R at a receiver over unknown land cover

  /// Loss (dB) of a path relative to free space.
  /// @param rx_msl_m  of the antenna; see p1812Path
  EMSCAPE_HD Real excessDb(const ClearAirColumn<Real>& column, Real rx_msl_m) const;
};

/// Min distance of clutter from either antenna (m), as P.452-18 has it; the recommendation leaves out the
/// first and the last point of a profile, at whatever spacing.
constexpr double kP1812ClutterDistance_m = 50;

/// sigma_L (dB) outdoors, at and below the height of the clutter.
/// @param resolution_m  w_a: width of the square over which the loss varies
/// @see P.1812-8 section 4.7
inline double p1812LocationDeviationDb(double frequency_hz, double resolution_m) {
  return (0.52 + 0.024 * frequency_hz / 1e9) * std::pow(resolution_m, 0.28);
}

/// u_h: fraction of the location variability at a height above ground.
/// @see P.1812-8 section 4.7
template <class Real>
EMSCAPE_HD Real p1812LocationPart(Real height_agl_m, Real clutter_height_m) {
  const Real part = 1 - (height_agl_m - clutter_height_m) / 10;
  return part < 0 ? Real(0) : part > 1 ? Real(1) : part;
}

/// L_bs: basic transmission loss (dB) by troposcatter.
/// @see P.1812-8 eq. (44), (45)
template <class Real>
EMSCAPE_HD Real p1812TroposcatterDb(const P1812Model<Real>& model, Real distance_m, Real angle_mrad) {
  const Real log_f = std::log10(model.clear_air.frequency_ghz), half = log_f - Real(0.30102999566);
  return Real(190.1) + 25 * log_f - Real(2.5) * half * half + 20 * std::log10(distance_m / 1000) +
         Real(0.573) * angle_mrad - Real(0.15) * model.sea_level_refractivity -
         Real(10.125) * std::pow(std::log10(50 / model.clear_air.time_percent), Real(0.7));
}

/// One path and the parts of its loss.
template <class Real>
struct P1812Path {
  ClearAirPath<Real> geometry;
  ClearAirLoss<Real> median;  ///< of locations
  Real location_db = 0;       ///< additional loss for the percentage of locations
  Real loss_db = 0;           ///< L_b: basic transmission loss
};

/// @param rx_msl_m  of the antenna; at least 1 m above the ground
/// @see P.1812-8 sections 4.7 and 4.9, eq. (69), outdoors
template <class Real>
EMSCAPE_HD P1812Path<Real> p1812Path(const P1812Model<Real>& model, const ClearAirColumn<Real>& column,
                                     Real rx_msl_m) {
  P1812Path<Real> path;
  path.geometry = clearAirPath(model.clear_air, column, rx_msl_m);
  ClearAirTerms<Real> terms;
  terms.troposcatter_db = p1812TroposcatterDb(model, column.distance_m, path.geometry.angle_mrad);
  terms.obstruction_mrad = path.geometry.angle_mrad;
  path.median = clearAirLoss(model.clear_air, column, path.geometry, terms);
  if (!column.zones.ends_at_sea) {
    path.location_db =
        -model.location_deviate * model.location_deviation_db *
        p1812LocationPart(path.geometry.rx_m - column.rx_ground_m,
                          column.posts.profile.clutter_m(column.posts.count() - 1, model.clutter_height_m));
  }
  const Real loss_db = path.median.loss_db + path.location_db;
  path.loss_db = loss_db > path.median.sight.loss_db ? loss_db : path.median.sight.loss_db;
  return path;
}

template <class Real>
EMSCAPE_HD Real P1812Model<Real>::excessDb(const ClearAirColumn<Real>& column, Real rx_msl_m) const {
  const P1812Path<Real> path = p1812Path(*this, column, rx_msl_m);
  return path.loss_db - path.median.sight.free_space_db;
}

}  // namespace emscape::propagation
