/// The field of a ground wave over a smooth earth between antennas on the ground, as a sum of modes; for
/// comparison with LFMF, independent of the march.
#pragma once

#include <cmath>
#include <complex>

#include "emscape/base/units.h"
#include "propagation/ground_constants.h"

namespace emscape::emfield {

/// Zero s = 1, 2, ... of Ai', with the sign changed. @see Abramowitz and Stegun 10.4.95
inline double airyDerivativeZero(int s) {
  constexpr double kFirst[] = {1.018792972, 3.248197582, 4.820099211, 6.163307356, 7.372177255};
  if (s <= 5) return kFirst[s - 1];
  const double t = 3 * kPi * (4 * s - 3) / 8, square = 1 / (t * t);
  return std::pow(t, 2.0 / 3) * (1 - square * (7.0 / 48 - square * 35.0 / 288));
}

/// Field (dB) over that in free space, vertical polarisation, of the modes of van der Pol and Bremmer: the
/// roots t of w'(t) = q w(t) are followed from q = 0 by dt/dq = 1 / (t - q^2). Time dependence exp(-i omega
/// t).
/// @param earth_m   effective radius of the earth
/// @param distance_m  beyond the horizon: 60 modes are summed
inline double groundWaveDb(double frequency_hz, const propagation::GroundConstants& ground, double earth_m,
                           double distance_m) {
  using Cx = std::complex<double>;
  const Cx permittivity{ground.relative_permittivity, ground.lossFactor(frequency_hz)};
  const double scale = std::cbrt(kPi * earth_m / wavelength_m(frequency_hz));
  const Cx q = Cx(0, scale) * std::sqrt(permittivity - 1.0) / permittivity;
  const double x = scale * distance_m / earth_m;
  constexpr int kModes = 60, kSteps = 1000;
  Cx sum = 0;
  for (int s = 1; s <= kModes; ++s) {
    Cx t = std::polar(airyDerivativeZero(s), kPi / 3);
    const auto slope = [&q](Cx root, double part) { return q / (root - part * part * q * q); };
    constexpr double kStep = 1.0 / kSteps;
    for (int i = 0; i < kSteps; ++i) {  // Runge and Kutta
      const double part = i * kStep;
      const Cx a = slope(t, part), b = slope(t + kStep / 2 * a, part + kStep / 2),
               c = slope(t + kStep / 2 * b, part + kStep / 2), d = slope(t + kStep * c, part + kStep);
      t += kStep / 6 * (a + 2.0 * b + 2.0 * c + d);
    }
    sum += std::exp(Cx(0, x) * t) / (t - q * q);
  }
  return 20 * std::log10(2 * std::sqrt(kPi * x) * std::abs(sum));
}

}  // namespace emscape::emfield
