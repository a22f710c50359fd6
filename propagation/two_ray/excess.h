/// Excess of the model `two_ray` over columns.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/propagation/reflected_ray.h"
#include "propagation/column.h"
#include "propagation/two_ray/two_ray.h"

namespace emscape::propagation {

/// In double precision: phases are path differences of many wavelengths.
struct TwoRayExcess {
  static constexpr bool kNeedsTerrain = false;
  static constexpr bool kOnEffectiveEarth = true;
  static constexpr bool kInParts = false;
  static constexpr bool kReflects = true;

  TwoRayModel<double> model;  ///< of horizontal polarisation, if `both`
  TwoRayModel<double> vertical;
  bool both = false;  ///< slanted or circular: half of the power each
  double surface_msl_m = 0;
  double tx_msl_m = 0;

  /// The reflected ray at a height, and the excess (dB) between isotropic antennas.
  EMSCAPE_HD ReflectedRay reflectedRay(double range_m, float height_msl_m, float& excess_db) const {
    return reflectedRay(range_m, tx_msl_m, static_cast<double>(height_msl_m), excess_db);
  }
  /// The same from any height to any other.
  EMSCAPE_HD ReflectedRay reflectedRay(double range_m, double from_msl_m, double to_msl_m,
                                       float& excess_db) const {
    const double h1 = from_msl_m - surface_msl_m, h2 = to_msl_m - surface_msl_m;
    const TwoRayPath<double> path = twoRayPath(model, range_m, h1, h2);
    double excess = path.excess_db, re = path.reflected.re, im = path.reflected.im;
    if (both) {
      const TwoRayPath<double> other = twoRayPath(vertical, range_m, h1, h2);
      excess = -10 * std::log10((std::pow(10.0, -excess / 10) + std::pow(10.0, -other.excess_db / 10)) / 2);
      const double mean_square = (norm(path.reflected) + norm(other.reflected)) / 2;
      re = (re + other.reflected.re) / 2;
      im = std::sqrt(mean_square > re * re ? mean_square - re * re : 0);
    }
    excess_db = static_cast<float>(excess);
    ReflectedRay ray;
    ray.re = static_cast<float>(re);
    ray.im = static_cast<float>(im);
    ray.weight = static_cast<float>(path.weight);
    ray.depression_sine = static_cast<float>(path.depression_sine);
    ray.is_envelope = model.sum == TwoRaySum::envelope;
    return ray;
  }

  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch&, float* excess_db) const {
    for (int k = 0; k < column.count; ++k) {
      reflectedRay(column.range_m, column.height_msl_m[k], excess_db[k]);
    }
    return 0;
  }
};

}  // namespace emscape::propagation
