/// Doppler filters: improvement factor, and response to a target's radial speed.
///
/// A filter is a weighted sum of N pulses. The clutter's spectrum is Gaussian with standard deviation s (Hz)
/// about zero, so that its correlation over k pulses is rho(k) = exp(-2 (pi s k / PRF)^2).
#pragma once

#include <optional>

#include "emscape/scenario/model/clutter.h"

namespace emscape::emfield {

/// A filter in a radar.
struct MtiFilter {
  scenario::Mti mti;
  double prf_hz = 0;
  double frequency_hz = 0;  ///< carrier

  /// Ratio of the echo's power over noise after the filter to that before it, for a target with a radial
  /// speed. canceller: |sum of w_i exp(2 pi j f i / PRF)|^2 / sum of w_i^2, 0 at the blind speeds, 1 in the
  /// mean. pulse_doppler: 1, because the coherent gain is part of the receiver's processing gain.
  /// @param radial_speed_mps  none: the mean of all speeds
  double response(std::optional<double> radial_speed_mps) const;

  /// Improvement factor of the echo over clutter (ratio), >= 1 for clutter narrower than the PRF: canceller:
  /// mean of all speeds, sum of w_i^2 / sum of w_i w_j rho(i - j); pulse_doppler: (sum of a_i)^2 / sum of a_i
  /// a_j rho(i - j) cos(2 pi f (i - j) / PRF), with the weights a of the minimum 4-term Blackman-Harris
  /// window and the target's Doppler frequency f. The limit by instability is included as 1 / I = 1 /
  /// I_filter + 1 / I_limit.
  /// @param spread_mps        standard deviation of the clutter's radial speed, >= 0
  /// @param radial_speed_mps  of the target (pulse_doppler); none: the middle between two blind speeds
  /// @return infinity for clutter without spread and without limit
  /// @see M. A. Richards, Fundamentals of Radar Signal Processing, 2nd ed., section 5.4, for the canceller;
  /// F. J. Harris, Proc. IEEE 66 (1978), p. 51, for the window
  double improvement(double spread_mps, std::optional<double> radial_speed_mps) const;
};

}  // namespace emscape::emfield
