/// Field of an antenna at the start of a march, as sine coefficients.
#pragma once

#include <cmath>
#include <complex>

#include "emscape/base/units.h"
#include "propagation/inputs.h"

namespace emscape::propagation {

struct PeSource {
  double height_agl_m = 0;
  /// Amplitude of the pattern against the angle above the horizontal (rad), 1 at the peak, the tilt included;
  /// empty: isotropic.
  ElevationPattern pattern;
};

/// Taper of the band: 1 up to 0.6 of its largest wavenumber, 0 from 0.9, between them a squared cosine of a
/// smooth step, whose first five derivatives are continuous: a break in the spectrum would leave a field
/// beyond the horizon at about -110 dB.
inline double bandTaper(double part_of_band) {
  constexpr double kFlat = 0.6, kEnd = 0.9;
  if (part_of_band <= kFlat) return 1;
  if (part_of_band >= kEnd) return 0;
  const double t = (part_of_band - kFlat) / (kEnd - kFlat);
  const double cosine = std::cos(kPi / 2 * t * t * t * (10 - 15 * t + 6 * t * t));
  return cosine * cosine;
}

/// Spectrum of the source in the unbounded plane, at vertical wavenumber p (rad/m) of either sign: the field
/// of amplitude 1 / sqrt(wavelength x) at a range x is u(0, z) = 1 / (2 pi) integral of spectrum(p) exp(i p
/// z) dp.
/// @param k      wavenumber (rad/m)
/// @param p_max  end of the band
/// @param wide   of the wide-angle form; the narrow one has no obliquity factor
inline std::complex<double> sourceSpectrum(const PeSource& source, double p, double p_max, double k,
                                           bool wide) {
  const double taper = bandTaper(std::fabs(p) / p_max);
  const double sine = p / k;
  if (taper == 0 || std::fabs(sine) >= 1) return 0;
  const double gain = source.pattern ? source.pattern(std::asin(sine)) : 1;
  const double obliquity = wide ? std::pow(1 - sine * sine, -0.25) : 1;
  return std::polar(taper * gain * obliquity, -p * source.height_agl_m);
}

}  // namespace emscape::propagation
