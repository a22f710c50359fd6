/// Bullington's construction for receivers clear of the smooth earth, in one pass over the posts of a path.
///
/// All heights of the receivers are known before the pass, so that no post is stored and visited again. With
/// many receivers DiffractionColumn takes less time.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::propagation {

template <class Real, int kReceivers>
class ObstacleMaxima {
 public:
  /// Heights are relative to the ground below the transmitter.
  /// @param distance_m   > 0
  /// @param tx_m, rx_m   of the antennas; see kDiffractionAboveGround
  EMSCAPE_HD ObstacleMaxima(const DiffractionModel<Real>& model, Real distance_m, Real tx_m,
                            const Real (&rx_m)[kReceivers])
      : distance_m_(distance_m), tx_m_(tx_m), half_curvature_(model.half_curvature) {
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      slope_[j] = (rx_m[j] - tx_m) / distance_m;
      from_rx_[j] = clearance_[j] = -Real(HUGE_VAL);
    }
  }

  /// Adds an obstacle: a post between the transmitter and the receivers.
  EMSCAPE_HD void add(Real range_m, Real height_m) {
    const Real beyond_m = distance_m_ - range_m;
    const Real root = inverseRoot(range_m * beyond_m);
    const Real above_tx_m = height_m - tx_m_ + half_curvature_ * range_m * beyond_m;
    const Real per_beyond = root * root * range_m;
    from_tx_ = largest(from_tx_, root * root * beyond_m * above_tx_m);
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      const Real above_m = above_tx_m - slope_[j] * range_m;  // the line of sight
      from_rx_[j] = largest(from_rx_[j], above_m * per_beyond);
      clearance_[j] = largest(clearance_[j], above_m * root);
    }
  }

  /// Bullington's loss (dB) of receiver j; 0 without an obstacle.
  /// @param model  that of the constructor
  EMSCAPE_HD Real lossDb(const DiffractionModel<Real>& model, int j) const {
    const Real scale = std::sqrt(2 * distance_m_ / model.earth.wavelength_m);
    const Real from_tx = from_tx_ - slope_[j];
    const Real relative = from_tx >= 0 ? std::sqrt(from_tx * largest(from_rx_[j], 0)) : clearance_[j];
    return bullingtonLossDb(scale * relative, distance_m_);
  }

 private:
  static EMSCAPE_HD Real largest(Real a, Real b) { return a > b ? a : b; }
  static EMSCAPE_HD Real inverseRoot(Real x) {
#ifdef __CUDA_ARCH__
    return rsqrt(x);
#else
    return 1 / std::sqrt(x);
#endif
  }

  Real distance_m_, tx_m_, half_curvature_;
  Real from_tx_ = -Real(HUGE_VAL);  ///< largest slope of an obstacle from the transmitter
  // Of each receiver: the slope of the line of sight, and maxima over all obstacles: their slopes from the
  // receiver, relative to that line, and their heights above it over sqrt(d1 d2).
  Real slope_[kReceivers], from_rx_[kReceivers], clearance_[kReceivers];
};

}  // namespace emscape::propagation
