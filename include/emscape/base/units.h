/// Physical constants, unit conversions, and the units in which values are shown.
#pragma once

#include <array>
#include <cmath>
#include <type_traits>

#include "emscape/base/host_device.h"

namespace emscape {

constexpr double kPi = 3.14159265358979323846;
/// Speed of light in vacuum (m/s), exact (SI).
constexpr double kSpeedOfLight = 299792458.0;
/// Boltzmann constant (J/K), exact (SI).
constexpr double kBoltzmann = 1.380649e-23;
/// Impedance of free space (ohm), CODATA 2018.
constexpr double kFreeSpaceImpedance = 376.730313668;
/// Reference noise temperature (K), IEEE.
constexpr double kReferenceTemperature_K = 290.0;
/// Field strength (dBuV/m, RMS) of a power density of 0 dBW/m2: 10 log10(Z0) + 120.
constexpr double kFieldStrengthOfPowerDensity_db = 145.760306;
/// dBi of 0 dBd: the gain of a half-wave dipole.
constexpr double kDipoleGain_dbi = 2.15;

template <class Real>
EMSCAPE_HD constexpr Real degToRad(Real degrees) {
  static_assert(std::is_floating_point_v<Real>, "an integer angle would be cut to 0");
  return degrees * Real(kPi / 180.0);
}
template <class Real>
EMSCAPE_HD constexpr Real radToDeg(Real radians) {
  static_assert(std::is_floating_point_v<Real>, "an integer angle would be cut to 0");
  return radians * Real(180.0 / kPi);
}
/// Power ratio to decibels; ratio > 0.
inline double ratioToDb(double ratio) {
  return 10.0 * std::log10(ratio);
}
/// Decibels to power ratio.
inline double dbToRatio(double decibels) {
  return std::pow(10.0, decibels / 10.0);
}
/// Wavelength in vacuum (m); frequency_hz > 0.
EMSCAPE_HD constexpr double wavelength_m(double frequency_hz) {
  return kSpeedOfLight / frequency_hz;
}

/// Units of shown lengths and speeds. metric: km, m, m/s. nautical: nautical miles, feet, knots.
enum class Units { metric, nautical };
constexpr auto namesOf(Units) {
  return std::array{"metric", "nautical"};
}

/// Units of shown power densities and field strengths: as computed, dBm/m2, or V/m (RMS, of a plane wave).
enum class FieldUnit { stored, dbm, v_per_m };
constexpr auto namesOf(FieldUnit) {
  return std::array{"stored", "dbm", "v_per_m"};
}

/// How positions are written: "36.50000°N 84.20000°W", "36°30'00.0\"N 84°12'00.0\"W", "16S GF 50729 42646".
enum class PositionFormat { decimal, dms, mgrs };
constexpr auto namesOf(PositionFormat) {
  return std::array{"decimal", "dms", "mgrs"};
}

}  // namespace emscape
