/// The evaporation duct from bulk measurements: similarity theory of the marine surface layer.
#pragma once

#include <limits>
#include <optional>

#include "propagation/parabolic_equation/air/refractivity.h"

namespace emscape::propagation {

/// One measurement over the sea, with its limits.
struct BulkInputs {
  double air_temperature_k = 288.15;      ///< 223.15..323.15
  double sea_temperature_k = 288.15;      ///< of the surface; 270.55..309.15
  double relative_humidity_percent = 80;  ///< of the air, over water; 10..100
  double wind_m_s = 5;                    ///< 0..30; below 0.1 as 0.1
  double pressure_hpa = 1013.25;          ///< at sea level; 920..1060
  double salinity_psu = 35;               ///< of the sea; 0..60
  double sensor_height_m = 10;            ///< of temperature and humidity above the sea; 0.5..50
  double wind_height_m = 10;              ///< 0.5..50
};

/// Integrated stability functions: int_0^zeta (1 - phi(x)) / x dx, with zeta = z / L.
/// Unstable (zeta < 0): Businger and Dyer, phi_m = (1 - 16 zeta)^(-1/4), phi_h its square. Stable: the forms
/// of SHEBA (Grachev and others 2007), with NAVSLaM 2.0's coefficients: phi_m = 1 + 5 zeta (1 + zeta)^(1/3) /
/// (1 + zeta / 1.3), phi_h = 1 + (10 zeta + 4.5 zeta^2) / (1 + 3 zeta + zeta^2).
double stabilityOfWind(double zeta);
double stabilityOfHeat(double zeta);

struct BulkAir {
  /// M from the surface to 100 m, standard above; the levels are within 0.02 M-units of the theory.
  RefractivityProfile profile;
  /// Height of the minimum of M, below 100 m; 0: M increases from the surface; none (not defined): M
  /// decreases up to 100 m, or the profile below is impossible (above saturation, without vapour or above 50
  /// C).
  std::optional<double> duct_height_m;
  double friction_velocity_m_s = 0;  ///< u*
  double temperature_scale_k = 0;    ///< theta*
  double humidity_scale = 0;         ///< q* (kg/kg)
  double obukhov_length_m = 0;       ///< L; infinite: neutral
};

/// M over the sea by Monin and Obukhov's similarity theory: Charnock's constant 0.011, the roughness of
/// COARE 3.0 for heat and humidity, gusts of 1.25 w* with an inversion at 600 m.
/// @throws Error (bad_input) for inputs outside their limits
/// @see Frederickson, Navy Atmospheric Vertical Surface Layer Model (NAVSLaM) 2.0, Naval Postgraduate School
/// 2019: constants and forms
BulkAir bulkAir(const BulkInputs& inputs);

}  // namespace emscape::propagation
