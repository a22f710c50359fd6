/// ITM: quantiles of the attenuation in time, location and situation [Hufford 1995, sec. 5].
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/itm/path.h"
#include "propagation/normal_deviate.h"

namespace emscape::propagation {

enum class ItmClimate {
  equatorial = 1,
  continental_subtropical = 2,
  maritime_subtropical = 3,
  desert = 4,
  continental_temperate = 5,
  maritime_temperate_over_land = 6,
  maritime_temperate_over_sea = 7
};

namespace itm_detail {

/// Curve of a statistic against the effective distance [Alg 5.5].
template <class Real>
struct ClimateCurve {
  Real c1, c2;
  Real x1_m, x2_m, x3_m;

  EMSCAPE_HD Real at(Real effective_distance_m) const {
    const Real near = (effective_distance_m - x2_m) / x3_m;
    const Real far = (effective_distance_m / x1_m) * (effective_distance_m / x1_m);
    return (c1 + c2 / (1 + near * near)) * far / (1 + far);
  }
};

/// Factor of a statistic against the frequency [Alg 5.6].
template <class Real>
struct ClimateFactor {
  Real c1, c2, c3;

  /// @param q  ln(0.133 k)
  EMSCAPE_HD Real at(Real q) const { return c1 + c2 / (c3 * q * c3 * q + 1); }
};

/// Constants of one radio climate.
template <class Real>
struct ClimateStatistics {
  ClimateCurve<Real> median;        ///< V_med: all-year median above the reference (dB)
  ClimateCurve<Real> below, above;  ///< sigma_T-, sigma_T+: spread in time on either side of the median (dB)
  Real rare_factor, rare_from;      ///< C_D, z_D: the distribution's far tail
  ClimateFactor<Real> below_factor, above_factor;
};

/// @see Hufford 1995, sec. 5, table of climate constants
template <class Real>
EMSCAPE_HD ClimateStatistics<Real> statisticsOf(ItmClimate climate) {
  const auto make = [](ClimateCurve<double> m, ClimateCurve<double> b, ClimateCurve<double> a,
                       double rare_factor, double rare_from, ClimateFactor<double> fb,
                       ClimateFactor<double> fa) {
    const auto curve = [](const ClimateCurve<double>& c) {
      return ClimateCurve<Real>{Real(c.c1), Real(c.c2), Real(c.x1_m), Real(c.x2_m), Real(c.x3_m)};
    };
    return ClimateStatistics<Real>{curve(m),
                                   curve(b),
                                   curve(a),
                                   Real(rare_factor),
                                   Real(rare_from),
                                   {Real(fb.c1), Real(fb.c2), Real(fb.c3)},
                                   {Real(fa.c1), Real(fa.c2), Real(fa.c3)}};
  };
  constexpr ClimateFactor<double> kOne{1, 0, 0};
  switch (climate) {
    case ItmClimate::equatorial:
      return make({-9.67, 12.7, 144.9e3, 190.3e3, 133.8e3}, {2.13, 159.5, 762.2e3, 123.6e3, 94.5e3},
                  {2.11, 102.3, 636.9e3, 134.8e3, 95.6e3}, 1.224, 1.282, kOne, kOne);
    case ItmClimate::continental_subtropical:
      return make({-0.62, 9.19, 228.9e3, 205.2e3, 143.6e3}, {2.66, 7.67, 100.4e3, 172.5e3, 136.4e3},
                  {6.87, 15.53, 138.7e3, 143.7e3, 98.6e3}, 0.801, 2.161, kOne, {0.93, 0.31, 2.00});
    case ItmClimate::maritime_subtropical:
      return make({1.26, 15.5, 262.6e3, 185.2e3, 99.8e3}, {6.11, 6.65, 138.2e3, 242.2e3, 178.6e3},
                  {10.08, 9.60, 165.3e3, 225.7e3, 129.7e3}, 1.380, 1.282, kOne, kOne);
    case ItmClimate::desert:
      return make({-9.21, 9.05, 84.1e3, 101.1e3, 98.6e3}, {1.98, 13.11, 139.1e3, 132.7e3, 193.5e3},
                  {3.68, 159.3, 464.4e3, 93.1e3, 94.2e3}, 1.000, 20., kOne, {0.93, 0.19, 1.79});
    case ItmClimate::maritime_temperate_over_land:
      return make({-0.39, 2.86, 141.7e3, 315.9e3, 167.4e3}, {6.86, 10.38, 187.8e3, 169.6e3, 108.9e3},
                  {8.58, 13.97, 216.0e3, 152.0e3, 122.7e3}, 1.518, 1.282, kOne, kOne);
    case ItmClimate::maritime_temperate_over_sea:
      return make({3.15, 857.9, 2222.e3, 164.8e3, 116.3e3}, {8.51, 169.8, 609.8e3, 119.9e3, 106.6e3},
                  {8.43, 8.19, 136.2e3, 188.5e3, 122.9e3}, 1.518, 1.282, kOne, kOne);
    case ItmClimate::continental_temperate:
    default:
      return make({-0.62, 9.19, 228.9e3, 205.2e3, 143.6e3}, {2.68, 7.16, 93.7e3, 186.8e3, 133.5e3},
                  {4.75, 8.12, 93.2e3, 135.9e3, 113.4e3}, 1.224, 1.282, {0.92, 0.25, 1.77},
                  {0.93, 0.31, 2.00});
  }
}

}  // namespace itm_detail

/// Deviates of the three quantiles.
template <class Real>
struct ItmDeviates {
  Real time, location, situation;
};

/// Excess attenuation (dB) at a quantile.
/// @param reference_db  the reference attenuation
/// @param mode          of variability: 0 single message, 1 individual, 2 mobile, 3 broadcast; + 10: no
///                      location variability; + 20: no situation variability
/// @param deviates      of the mode; those that it does not use are set to those that it uses instead
template <class Real>
EMSCAPE_HD Real itmQuantileDb(const ItmPath<Real>& path, Real reference_db, ItmClimate climate, int mode,
                              ItmDeviates<Real>& deviates) {
  using namespace itm_detail;
  const bool no_situation = mode >= 20;
  const bool no_location = mode % 20 >= 10;
  mode %= 10;
  if (mode == 0) deviates.time = deviates.situation;
  if (mode == 0 || mode == 1) deviates.location = deviates.situation;
  if (mode == 2) deviates.location = deviates.time;
  const Real z_time = deviates.time;
  const Real z_location = deviates.location;
  const Real z_situation = deviates.situation;

  // effective distance [Alg 5.3]: over an earth of 9000 km radius
  const Real wave_number = path.waveNumber();
  const Real scale_m = std::sqrt(Real(2 * 9000e3) * path.terminal[0].effective_height_m) +
                       std::sqrt(Real(2 * 9000e3) * path.terminal[1].effective_height_m) +
                       std::cbrt(Real(575.7e12) / wave_number);
  const Real effective_m = path.distance_m < scale_m ? Real(130e3) * path.distance_m / scale_m
                                                     : Real(130e3) + path.distance_m - scale_m;

  const Real sigma_situation = no_situation ? Real(0) : 5 + 3 * std::exp(-effective_m / Real(100e3));
  Real sigma_location = 0;
  if (!no_location) {
    const Real roughness = itmIrregularityWithin_m(path.distance_m, path.irregularity_m) * wave_number;
    sigma_location = 10 * roughness / (roughness + 13);
  }

  const ClimateStatistics<Real> statistics = statisticsOf<Real>(climate);
  const Real q = std::log(Real(0.133) * wave_number);
  Real sigma_time;
  if (z_time < 0) {
    sigma_time = statistics.below.at(effective_m) * statistics.below_factor.at(q);
  } else {
    sigma_time = statistics.above.at(effective_m) * statistics.above_factor.at(q);
    if (z_time > statistics.rare_from) {
      const Real sigma_rare = statistics.rare_factor * sigma_time;
      sigma_time = sigma_rare + (sigma_time - sigma_rare) * statistics.rare_from / z_time;
    }
  }

  const Real y_time = sigma_time * z_time;
  const Real y_location = sigma_location * z_location;
  const Real square = z_situation * z_situation;
  // [Alg 5.11]
  Real variance = sigma_situation * sigma_situation + y_time * y_time / (Real(7.8) + square) +
                  y_location * y_location / (24 + square);
  Real y = 0;
  switch (mode) {
    case 0:
      variance += sigma_time * sigma_time + sigma_location * sigma_location;
      break;
    case 1:
      y = y_time;
      variance += sigma_location * sigma_location;
      break;
    case 2:
      y = std::sqrt(sigma_time * sigma_time + sigma_location * sigma_location) * z_time;
      break;
    default:
      y = y_time + y_location;
  }
  const Real excess_db =
      reference_db - statistics.median.at(effective_m) - y - std::sqrt(variance) * z_situation;
  // a gain over free space is limited [Alg 5.17]
  return excess_db >= 0 ? excess_db : excess_db * (29 - excess_db) / (29 - 10 * excess_db);
}

}  // namespace emscape::propagation
