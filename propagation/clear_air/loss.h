/// Basic transmission loss of a path: combination of the mechanisms in ITU-R P.1812 and P.452.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/clear_air/diffraction.h"
#include "propagation/clear_air/ducting.h"
#include "propagation/clear_air/line_of_sight.h"

namespace emscape::propagation {

/// Terms that the two models define differently.
template <class Real>
struct ClearAirTerms {
  Real gases_db_per_km = 0;   ///< along the path
  Real troposcatter_db = 0;   ///< L_bs
  Real obstruction_mrad = 0;  ///< angle of obstruction, the argument of F_j
};

/// Losses (dB) of one path, not exceeded in the model's percentage of time.
template <class Real>
struct ClearAirLoss {
  ClearAirSight<Real> sight;
  ClearAirDiffraction<Real> diffraction;
  Real diffraction_db = 0;             ///< L_bd
  Real ducting_db = 0;                 ///< L_ba
  Real sight_and_sub_path_db = 0;      ///< L_minb0p: line of sight with sub-path diffraction over land
  Real sight_or_ducting_db = 0;        ///< L_minbap
  Real diffraction_or_ducting_db = 0;  ///< L_bda
  Real without_scatter_db = 0;         ///< L_bam
  Real troposcatter_db = 0;            ///< L_bs
  Real loss_db = 0;                    ///< L_bc
  Real sight_part = 0;                 ///< F_j: 1 on a clear line of sight, 0 beyond the horizon
  Real near_part = 0;                  ///< F_k: 1 near the transmitter, 0 far from it
};

namespace clear_air_detail {

/// 1 well below a threshold, 0 well above it; P.1812-8 eq. (57), (58).
template <class Real>
EMSCAPE_HD Real fallingStep(Real sharpness, Real value, Real threshold) {
  return (1 - std::tanh(3 * sharpness * (value - threshold) / threshold)) / 2;
}

/// Combination of two mechanisms: -5 log10(10^(-a/5) + 10^(-b/5)).
template <class Real>
EMSCAPE_HD Real combinedDb(Real a_db, Real b_db) {
  const Real smaller = a_db < b_db ? a_db : b_db;
  return smaller - 5 * std::log10(1 + std::pow(Real(10), -std::fabs(a_db - b_db) / 5));
}

/// Smooth larger value: eta ln(exp(a / eta) + exp(b / eta)).
template <class Real>
EMSCAPE_HD Real blendedLargerDb(Real a_db, Real b_db) {
  constexpr Real kEta_db = Real(2.5);
  const Real larger = a_db > b_db ? a_db : b_db;
  return larger + kEta_db * std::log(1 + std::exp(-std::fabs(a_db - b_db) / kEta_db));
}

}  // namespace clear_air_detail

/// @see P.1812-8 section 4.6, eq. (42), (43), (57) to (63); P.452-18 section 4.5, eq. (43), (44), (58) to
/// (64)
template <class Real>
EMSCAPE_HD ClearAirLoss<Real> clearAirLoss(const ClearAirModel<Real>& model,
                                           const ClearAirColumn<Real>& column, const ClearAirPath<Real>& path,
                                           const ClearAirTerms<Real>& terms) {
  using namespace clear_air_detail;
  const Real d_km = column.distance_m / 1000;
  ClearAirLoss<Real> loss;
  loss.sight = clearAirSight(model, column, path, terms.gases_db_per_km);
  loss.diffraction = clearAirDiffraction(model, column, path);
  loss.ducting_db = ductingLossDb(model, column, path) + terms.gases_db_per_km * d_km;
  loss.troposcatter_db = terms.troposcatter_db;
  loss.sight_part = fallingStep(Real(0.8), terms.obstruction_mrad, Real(0.3));
  loss.near_part = fallingStep(Real(0.5), d_km, Real(20));

  const Real over_land_db = Real(1 - column.zones.sea_fraction) * loss.diffraction.loss_db;
  loss.diffraction_db = loss.sight.loss_db + loss.diffraction.loss_db;
  loss.sight_and_sub_path_db = loss.sight.loss_db + over_land_db;
  if (model.time_percent >= column.ducting_time_percent) {
    const Real median_db = loss.sight.median_db + loss.diffraction.median.loss_db;
    loss.sight_and_sub_path_db =
        median_db + (loss.sight.ducting_db + over_land_db - median_db) * loss.diffraction.interpolation;
  }
  loss.sight_or_ducting_db = blendedLargerDb(loss.ducting_db, loss.sight.loss_db);
  loss.diffraction_or_ducting_db = loss.diffraction_db;
  if (loss.sight_or_ducting_db <= loss.diffraction_db) {
    loss.diffraction_or_ducting_db =
        loss.sight_or_ducting_db + (loss.diffraction_db - loss.sight_or_ducting_db) * loss.near_part;
  }
  loss.without_scatter_db = loss.diffraction_or_ducting_db +
                            (loss.sight_and_sub_path_db - loss.diffraction_or_ducting_db) * loss.sight_part;
  loss.loss_db = combinedDb(loss.troposcatter_db, loss.without_scatter_db);
  return loss;
}

}  // namespace emscape::propagation
