/// Operations of a step of the march at one height or one wavenumber, for host and device.
#pragma once

#include <cmath>

#include "emscape/base/units.h"
#include "propagation/complex.h"
#include "propagation/diffraction/knife_edge.h"
#include "propagation/parabolic_equation/air/refractivity.h"

namespace emscape::propagation {

/// Sines of the slopes (15 degrees; 30 if the band holds them wholly) and of the break of slope (45 degrees,
/// or the band's largest angle) above which a terrain segment is replaced by a step of a staircase. A steep
/// slope that is held in part fills the shadow behind it with a false field.
constexpr double kMaxSlopeSine = 0.25881904510252076, kMaxHeldSlopeSine = 0.5;
constexpr double kMaxBreakSine = 0.70710678118654752;

/// exp(a).
EMSCAPE_HD inline Complex<double> exponential(Complex<double> a) {
  const double magnitude = std::exp(a.re);
  return {magnitude * std::cos(a.im), magnitude * std::sin(a.im)};
}

/// Absorption rate (1/m) of the last tenth of the band. Rays that leave the band are reflected downwards at
/// its edge. Standard air turns rays out of the band slowly: 90 dB over the range in which it turns a ray
/// through that tenth. Over terrain a break of slope does so at once: 90 dB in a step, which removes the
/// reflections of breaks by up to a fifth of the band.
EMSCAPE_HD inline double bandEdgeRate(double part_of_band, double max_sine, double range_step_m,
                                      bool over_terrain) {
  constexpr double kBegin = 0.9, kLoss = 90 / kDbPerNeper<double>;
  const double t = (part_of_band - kBegin) / (1 - kBegin);
  if (t <= 0) return 0;
  const double turning_m = (1 - kBegin) * max_sine / (1e-6 * kStandardGradient_m);
  return (over_terrain ? kLoss / range_step_m : 4 * kLoss / turning_m) * t * t * t;
}

/// i distance (sqrt(k^2 - q^2) - k) without cancellation; its real part is negative where q > k. The narrow
/// form's: -i distance q^2 / 2k.
EMSCAPE_HD inline Complex<double> stepExponent(bool wide, double k, double distance_m,
                                               Complex<double> q_squared) {
  if (!wide) return Complex<double>{0, -distance_m / (2 * k)} * q_squared;
  Complex<double> root = sqrt(Complex<double>{k * k - q_squared.re, -q_squared.im});
  if (root.im < 0) root = Complex<double>{-root.re, -root.im};
  return Complex<double>{0, -distance_m} * q_squared / Complex<double>{root.re + k, root.im};
}

/// One range step over the ground.
struct GroundStep {
  double sine = 0, cosine = 1;  ///< of the slope
  /// Sine of the previous slope minus that of this one: the break multiplies the field by exp(i k z turn).
  double turn = 0;
  double stair_m = 0;  ///< rise of the step of a staircase at the end: the rest of the rise
};

/// @param rise_m       over the step
/// @param sine_before  of the slope of the step before
/// @param first        the march's first step: the source's band is centred on its slope
/// @param max_sine     of the band
/// @param slope_part   MarchGrid::slope_part
EMSCAPE_HD inline GroundStep groundStep(double rise_m, double range_step_m, double sine_before, bool first,
                                        double max_sine, double slope_part) {
  GroundStep step;
  const double length_m = std::sqrt(range_step_m * range_step_m + rise_m * rise_m);
  step.sine = rise_m / length_m;
  step.cosine = range_step_m / length_m;
  const double turn = first ? 0 : sine_before - step.sine;
  const double largest = max_sine < kMaxBreakSine ? max_sine : kMaxBreakSine;
  const double held = slope_part * max_sine, slope = std::fabs(step.sine);
  if ((slope > kMaxSlopeSine && slope > held) || slope > kMaxHeldSlopeSine || std::fabs(turn) > largest) {
    return {0, 1, first ? 0 : sine_before, rise_m};
  }
  if (slope > held) {
    step.sine = step.sine > 0 ? held : -held;
    step.cosine = std::sqrt(1 - held * held);
    step.stair_m = rise_m - range_step_m * step.sine / step.cosine;
  }
  step.turn = first ? 0 : sine_before - step.sine;
  return step;
}

/// Fraction of the range steps with ground that the band does not hold: all or the rest of their rise is a
/// step of a staircase.
/// @param ground_m  heights at the range steps 0 .. steps
template <class Height>
double staircasePart(const Height* ground_m, int steps, double range_step_m, double max_sine,
                     double slope_part) {
  double sine = 0;
  int staircases = 0;
  for (int i = 0; i < steps; ++i) {
    const double rise_m = double(ground_m[i + 1]) - double(ground_m[i]);
    const GroundStep step = groundStep(rise_m, range_step_m, sine, i == 0, max_sine, slope_part);
    if (step.stair_m != 0) ++staircases;
    sine = step.sine;
  }
  return steps > 0 ? double(staircases) / steps : 0;
}

}  // namespace emscape::propagation
