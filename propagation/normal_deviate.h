/// Quantiles of the standard normal distribution, for the models' statistics of time and location.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// Standard normal deviate that is exceeded with a probability: Q^-1.
/// @param probability  0..1, exclusive
/// @accuracy 4.5e-4
/// @see Abramowitz and Stegun 26.2.23, which ITM, P.1812 and P.452 prescribe
template <class Real>
EMSCAPE_HD Real normalDeviate(Real probability) {
  const Real tail = probability > Real(0.5) ? 1 - probability : probability;
  const Real t = std::sqrt(-2 * std::log(tail));
  const Real deviate = t - ((Real(0.010328) * t + Real(0.802853)) * t + Real(2.515516698)) /
                               (((Real(0.001308) * t + Real(0.189269)) * t + Real(1.432788)) * t + 1);
  return probability > Real(0.5) ? -deviate : deviate;
}

}  // namespace emscape::propagation
