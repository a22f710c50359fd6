/// Ducting and layer reflection: ITU-R P.1812-8 section 4.5, P.452-18 section 4.4.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/clear_air/climate.h"
#include "propagation/clear_air/path.h"

namespace emscape::propagation {

namespace clear_air_detail {

/// A_st, A_sr: shielding of an antenna by its horizon (dB), P.1812-8 eq. (48).
template <class Real>
EMSCAPE_HD Real siteShieldingDb(Real frequency_ghz, Real angle_mrad, Real distance_km) {
  const Real above_mrad = angle_mrad - Real(0.1) * distance_km;
  if (!(above_mrad > 0)) return 0;
  return 20 * std::log10(1 + Real(0.361) * above_mrad * std::sqrt(frequency_ghz * distance_km)) +
         Real(0.264) * above_mrad * std::cbrt(frequency_ghz);
}

/// A_ct, A_cr: coupling into ducts over the sea (dB), P.1812-8 eq. (49).
template <class Real>
EMSCAPE_HD Real seaCouplingDb(Real coast_km, Real horizon_km, Real sea_fraction, Real height_msl_m) {
  if (!(coast_km <= 5 && coast_km <= horizon_km && sea_fraction >= Real(0.75))) return 0;
  return -3 * std::exp(Real(-0.25) * coast_km * coast_km) * (1 + std::tanh(Real(0.07) * (50 - height_msl_m)));
}

/// beta (%): time percentage of ducting, with the path's geometry and roughness; eq. (54) to (56).
template <class Real>
EMSCAPE_HD Real ductingPathTime_percent(const ClearAirColumn<Real>& column, const ClearAirPath<Real>& path,
                                        Real earth_radius_km) {
  const Real d_km = column.distance_m / 1000;
  Real alpha =
      Real(-0.6) - Real(3.5e-9) * std::pow(d_km, Real(3.1)) * inlandPart(Real(column.zones.longest_inland_m));
  alpha = alpha > Real(-3.4) ? alpha : Real(-3.4);
  const Real roots = std::sqrt(path.ducting_height_m[0]) + std::sqrt(path.ducting_height_m[1]);
  const Real geometry = std::pow(500 / earth_radius_km * d_km * d_km / (roots * roots), alpha);
  Real roughness = 1;
  if (path.roughness_m > 10) {
    const Real between_km = d_km - (path.horizon_distance_m[0] + path.horizon_distance_m[1]) / 1000;
    roughness = std::exp(Real(-4.6e-5) * (path.roughness_m - 10) *
                         (43 + 6 * (between_km < 40 ? between_km : Real(40))));
  }
  return column.ducting_time_percent * (geometry < 1 ? geometry : Real(1)) * roughness;
}

}  // namespace clear_air_detail

/// L_ba: basic transmission loss (dB) by ducts, without gases.
/// @see P.1812-8 eq. (46) to (56); P.452-18 eq. (46) to (57)
template <class Real>
EMSCAPE_HD Real ductingLossDb(const ClearAirModel<Real>& model, const ClearAirColumn<Real>& column,
                              const ClearAirPath<Real>& path) {
  using namespace clear_air_detail;
  const Real f = model.frequency_ghz;
  const Real d_km = column.distance_m / 1000;
  const Real earth_radius_km = model.median.earth.earth_radius_m / 1000;
  const Real height_m[2] = {column.tx_m, path.rx_m};
  Real coupling_db = f < Real(0.5) ? Real(45.375) + (Real(92.5) * f - 137) * f : Real(0);  // A_lf
  Real angle_mrad = 1000 * d_km / earth_radius_km;                                         // theta'
  Real horizons_km = 0;
  for (int end = 0; end < 2; ++end) {
    const Real horizon_km = path.horizon_distance_m[end] / 1000,
               elevation_mrad = path.horizon_angle_mrad[end];
    horizons_km += horizon_km;
    coupling_db += siteShieldingDb(f, elevation_mrad, horizon_km);
    coupling_db += seaCouplingDb(Real(column.zones.coast_distance_m[end] / 1000), horizon_km,
                                 Real(column.zones.sea_fraction), height_m[end] + column.base_msl_m);
    angle_mrad += elevation_mrad < Real(0.1) * horizon_km ? elevation_mrad : Real(0.1) * horizon_km;
  }
  const Real fixed_db =
      Real(102.45) + 20 * std::log10(f) + 20 * std::log10(horizons_km) + coupling_db;  // A_f

  const Real beta = ductingPathTime_percent(column, path, earth_radius_km);
  const Real log_beta = std::log10(beta);
  const Real gamma = Real(1.076) / std::pow(Real(2.0058) - log_beta, Real(1.012)) *
                     std::exp(-(Real(9.51) + (Real(0.198) * log_beta - Real(4.8)) * log_beta) * Real(1e-6) *
                              std::pow(d_km, Real(1.13)));
  const Real ratio = model.time_percent / beta;
  const Real time_db =
      -12 + (Real(1.2) + Real(3.7e-3) * d_km) * std::log10(ratio) + 12 * std::pow(ratio, gamma);
  return fixed_db + Real(5e-5) * earth_radius_km * std::cbrt(f) * angle_mrad + time_db;
}

}  // namespace emscape::propagation
