/// Model `rain`: specific attenuation from rain, ITU-R P.838-3.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kRainFrequency{"frequency",
                                    "GHz",
                                    1e9,
                                    1,
                                    1000,
                                    Beyond::clamped_quietly,
                                    "range of the fits; below 1 GHz rain attenuates by less than 0.01 dB/km"};
constexpr ModelLimit kRainRate{
    "rain rate", "mm/h", 1, 0, 200, Beyond::refused, "the maps of P.837 have no higher rates"};
constexpr const ModelLimit* kRainLimits[] = {&kRainFrequency, &kRainRate};

/// gamma = k R^alpha (P.838-3 eq. (1)).
template <class Real>
struct RainCoefficients {
  Real k = 0;
  Real alpha = 1;

  /// Specific attenuation (dB/km) in rain of a rate (mm/h); 0 without rain.
  /// @accuracy float within 1e-5 of double, relative
  EMSCAPE_HD Real specificAttenuation_db_per_km(Real rain_mm_h) const {
    return rain_mm_h > 0 ? k * Real(std::pow(rain_mm_h, alpha)) : Real(0);
  }
};

/// @param frequency_hz   1 to 1000 GHz; clamped outside
/// @param elevation_rad  of the path
/// @param tilt_rad       of the polarisation: 0 horizontal, pi/2 vertical, pi/4 circular
/// @see P.838-3 eq. (2) to (5)
RainCoefficients<double> rainCoefficients(double frequency_hz, double elevation_rad, double tilt_rad);

}  // namespace emscape::propagation
