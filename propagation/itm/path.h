/// ITM: the inputs of the reference attenuation, found along a terrain profile (profile.h) or estimated from
/// the terrain's irregularity (area mode).
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/complex.h"

namespace emscape::propagation {

namespace itm_detail {

template <class Real>
EMSCAPE_HD Real larger(Real a, Real b) {
  return a < b ? b : a;
}
template <class Real>
EMSCAPE_HD Real smaller(Real a, Real b) {
  return b < a ? b : a;
}
}  // namespace itm_detail

/// MHz m: the wave number is k = f / 47.7 (1/m), f in MHz [Alg 1.1].
constexpr double kItmWaveNumberScale = 47.7;

/// One end of a path: 0 is the transmitter, 1 the receiver.
template <class Real>
struct ItmTerminal {
  Real height_agl_m = 0;        ///< structural height
  Real effective_height_m = 0;  ///< above the dominating reflecting plane
  Real horizon_distance_m = 0;
  Real horizon_angle_rad = 0;  ///< elevation of the horizon
};

template <class Real>
struct ItmPath {
  ItmTerminal<Real> terminal[2];
  Real distance_m = 0;
  Real irregularity_m = 0;  ///< Delta h: interdecile range of the terrain's heights, for long paths
  Real effective_earth_radius_m = 0;
  Real surface_refractivity = 0;  ///< N_s (N-units)
  Real frequency_mhz = 0;
  Complex<Real> ground_impedance;  ///< Z_g, relative to free space
  bool profile_is_known = false;   ///< point-to-point

  EMSCAPE_HD Real waveNumber() const { return frequency_mhz / Real(kItmWaveNumberScale); }
  /// d_L: sum of the horizon distances.
  EMSCAPE_HD Real horizonDistance_m() const {
    return terminal[0].horizon_distance_m + terminal[1].horizon_distance_m;
  }
  /// Of one terminal, over a smooth earth [Alg 3.5].
  EMSCAPE_HD Real smoothHorizonDistance_m(int end) const {
    return std::sqrt(2 * terminal[end].effective_height_m * effective_earth_radius_m);
  }
  /// d_Ls: sum of the horizon distances over a smooth earth.
  EMSCAPE_HD Real smoothHorizonDistance_m() const {
    return smoothHorizonDistance_m(0) + smoothHorizonDistance_m(1);
  }
  /// Sum of the horizons' elevations.
  EMSCAPE_HD Real horizonAngle_rad() const {
    return terminal[0].horizon_angle_rad + terminal[1].horizon_angle_rad;
  }
  /// theta: angle by which a path of this length bends beyond the horizons [Alg 3.8, 4.12].
  EMSCAPE_HD Real beyondHorizon_rad(Real path_length_m) const {
    return itm_detail::larger(horizonAngle_rad(), -horizonDistance_m() / effective_earth_radius_m) +
           path_length_m / effective_earth_radius_m;
  }
};

/// Delta h(s): the irregularity over a path of length s [Alg 3.9].
template <class Real>
EMSCAPE_HD Real itmIrregularityWithin_m(Real distance_m, Real irregularity_m) {
  return irregularity_m * (1 - Real(0.8) * std::exp(-distance_m / Real(50e3)));
}

/// sigma_h: standard deviation of the terrain's heights within the first Fresnel zone [Alg 3.10].
template <class Real>
EMSCAPE_HD Real itmTerrainDeviation_m(Real irregularity_m) {
  return Real(0.78) * irregularity_m * std::exp(-std::sqrt(std::sqrt(irregularity_m / 16)));
}

/// Sets the parameters that depend on ground, atmosphere and frequency [Alg 1.2-1.5].
/// @param sea_level_refractivity  N_0 (N-units)
/// @param mean_height_msl_m       of the terrain along the path; 0 where it is unknown
template <class Real>
EMSCAPE_HD void itmSetMedium(ItmPath<Real>& path, Real frequency_hz, bool vertical_polarization,
                             Real relative_permittivity, Real conductivity_s_m, Real sea_level_refractivity,
                             Real mean_height_msl_m) {
  path.frequency_mhz = frequency_hz / Real(1e6);
  path.surface_refractivity = sea_level_refractivity * std::exp(-mean_height_msl_m / 9460);
  path.effective_earth_radius_m =
      1 / (Real(157e-9) * (1 - Real(0.04665) * std::exp(path.surface_refractivity / Real(179.3))));
  const Complex<Real> permittivity{relative_permittivity, 18000 * conductivity_s_m / path.frequency_mhz};
  path.ground_impedance = sqrt(permittivity - Complex<Real>{1, 0});
  if (vertical_polarization) path.ground_impedance = path.ground_impedance / permittivity;
}

/// Horizon distance and angle of a terminal of known effective height, only from the terrain's irregularity
/// [Alg 3.3, 3.4].
template <class Real>
EMSCAPE_HD void itmEstimateHorizon(ItmTerminal<Real>& terminal, Real smooth_horizon_distance_m,
                                   Real irregularity_m) {
  const Real height_m = terminal.effective_height_m;
  const Real shortening =
      std::exp(Real(-0.07) * std::sqrt(irregularity_m / (height_m > 5 ? height_m : Real(5))));
  terminal.horizon_distance_m = smooth_horizon_distance_m * shortening;
  terminal.horizon_angle_rad =
      (Real(0.65) * irregularity_m * (1 / shortening - 1) - 2 * height_m) / smooth_horizon_distance_m;
}

}  // namespace emscape::propagation
