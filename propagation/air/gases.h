/// Model `gases`: attenuation by oxygen and water vapour, ITU-R P.676-13, and the standard atmosphere, ITU-R
/// P.835-6.
#pragma once

#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kGasesFrequency{
    "frequency",
    "GHz",
    1e9,
    1,
    1000,
    Beyond::clamped_quietly,
    "of the function of P.676 alone; the field computes line by line at every frequency"};
constexpr ModelLimit kGasesSlantFrequency{
    "frequency (slant path)", "GHz", 1e9, 1, 350, Beyond::refused, "range of the equivalent heights"};
constexpr ModelLimit kGasesElevation{
    "elevation (slant path)",      "deg", 3.14159265358979323846 / 180, 5, 90, Beyond::refused,
    "a flat stratified atmosphere"};
constexpr ModelLimit kGasesHeight{
    "height",
    "km",
    1000,
    -1,
    100,
    Beyond::clamped_quietly,
    "no attenuation above 100 km; below sea level the lowest layer is continued"};
constexpr const ModelLimit* kGasesLimits[] = {&kGasesFrequency, &kGasesSlantFrequency, &kGasesElevation,
                                              &kGasesHeight};

/// State of the air at one point.
struct AirState {
  double pressure_hpa = 1013.25;  ///< total: dry air and vapour
  double temperature_k = 288.15;
  double vapour_g_m3 = 7.5;

  /// Partial pressure of the vapour (hPa): P.676-13 eq. (4).
  double vapourPressure_hpa() const { return vapour_g_m3 * temperature_k / 216.7; }
};

/// Specific attenuation (dB/km).
struct GasAttenuation {
  double oxygen_db_per_km = 0;
  double vapour_db_per_km = 0;

  double total_db_per_km() const { return oxygen_db_per_km + vapour_db_per_km; }
};

/// Line by line. Takes about 2 us: call it once per layer of air, not per voxel.
/// @param dry_pressure_hpa  of the dry air alone
/// @see P.676-13 Annex 1 eq. (1) to (9)
GasAttenuation gasAttenuation(double frequency_hz, double dry_pressure_hpa, double temperature_k,
                              double vapour_g_m3);
inline GasAttenuation gasAttenuation(double frequency_hz, const AirState& air) {
  return gasAttenuation(frequency_hz, air.pressure_hpa - air.vapourPressure_hpa(), air.temperature_k,
                        air.vapour_g_m3);
}

/// The same without limits of frequency, for models that use the equations also below 1 GHz.
GasAttenuation lineByLineGasAttenuation(double frequency_hz, double dry_pressure_hpa, double temperature_k,
                                        double vapour_g_m3);

/// The mean annual global reference atmosphere at a height above mean sea level (m); the vapour falls by a
/// factor of e per 2 km; its mixing ratio is at least 2e-6.
/// @param surface_vapour_g_m3  at mean sea level; 7.5 in the reference
/// @see P.835-6 Annex 1: eq. (2) and (3) up to 86 km of geometric height, (4) and (5) up to 100 km, (6) to
/// (8)
AirState standardAtmosphere(double height_msl_m, double surface_vapour_g_m3 = 7.5);

/// Attenuation (dB) of a path out of the atmosphere, from the state of the air at its lower end: the
/// approximate method.
/// @param elevation_rad  5 to 90 degrees
/// @return NaN outside kGasesSlantFrequency and kGasesElevation
/// @see P.676-13 Annex 2 eq. (28) to (37), method 1
double slantGasAttenuationDb(double frequency_hz, double elevation_rad, const AirState& surface);

}  // namespace emscape::propagation
