#include "propagation/ground_constants.h"

#include <cmath>
#include <complex>

namespace emscape::propagation {

GroundConstants waterConstants(double frequency_hz, double temperature_c, double salinity_g_per_kg) {
  const double f = frequency_hz / 1e9, t = temperature_c, s = salinity_g_per_kg;
  const double theta = 300 / (t + 273.15) - 1;

  // two relaxations of pure water
  const double still = 77.66 + 103.3 * theta;
  const double between = 0.0671 * still;
  const double fast = 3.52 - 7.52 * theta;
  const double f1 = 20.20 - 146.4 * theta + 316 * theta * theta;
  const double f2 = 39.8 * f1;

  // effect of salt on them
  const double salt_still = still * std::exp(s * (-3.33330e-3 + 4.74868e-6 * s));
  const double salt_f1 =
      f1 * (1 + s * (2.3232e-3 + t * (-7.9208e-5 + t * (3.6764e-6 + t * (-3.5594e-7 + t * 8.9795e-9)))));
  const double salt_between = between * std::exp(s * (-6.28908e-3 + 1.76032e-4 * s - 9.22144e-5 * t));
  const double salt_f2 = f2 * (1 + s * (-1.99723e-2 + 1.81176e-4 * t));
  const double salt_fast = fast * (1 + s * (-2.04265e-3 + 1.57883e-4 * t));

  const double sigma35 = 2.903602 + t * (8.607e-2 + t * (4.738817e-4 + t * (-2.991e-6 + t * 4.3047e-9)));
  const double r15 = s * (37.5109 + s * (5.45216 + s * 1.4409e-2)) / (1004.75 + s * (182.283 + s));
  const double alpha0 = (6.9431 + s * (3.2841 - s * 9.9486e-2)) / (84.850 + s * (69.024 + s));
  const double alpha1 = 49.843 + s * (-0.2276 + s * 0.198e-2);
  const double sigma = sigma35 * r15 * (1 + alpha0 * (t - 15) / (alpha1 + t));

  const std::complex<double> i(0, 1);
  const std::complex<double> turning = (salt_still - salt_between) / (1.0 + i * (f / salt_f1)) +
                                       (salt_between - salt_fast) / (1.0 + i * (f / salt_f2)) + salt_fast;
  return {turning.real(), sigma - turning.imag() * frequency_hz / GroundConstants::kSiemensPerMetreToLoss_hz};
}

GroundConstants groundConstants(GroundKind kind, double frequency_hz) {
  switch (kind) {
    case GroundKind::sea:
      return waterConstants(frequency_hz, 15, 35);
    case GroundKind::fresh_water:
      return waterConstants(frequency_hz, 15, 0);
    case GroundKind::wet_ground:
      return {25, 0.02};
    case GroundKind::average_ground:
      return {15, 0.005};
    case GroundKind::dry_ground:
      return {4, 0.001};
    case GroundKind::concrete:
      return {5.3, 0.1};
  }
  return {};
}

LinearPolarization linearPolarization(Polarization polarization) {
  return polarization == Polarization::horizontal ? LinearPolarization::horizontal
                                                  : LinearPolarization::vertical;
}

GroundConstants groundConstants(const Ground& ground, double frequency_hz) {
  GroundConstants constants = groundConstants(ground.kind, frequency_hz);
  constants.relative_permittivity = ground.relative_permittivity.value_or(constants.relative_permittivity);
  constants.conductivity_s_per_m = ground.conductivity_s_m.value_or(constants.conductivity_s_per_m);
  return constants;
}

}  // namespace emscape::propagation
