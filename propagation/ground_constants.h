/// Electrical constants of grounds and waters, and of the sea by ITU-R P.527.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/propagation/settings.h"

namespace emscape::propagation {

/// Orientation of a wave's electric field to the ground.
enum class LinearPolarization { horizontal, vertical };
/// Mixed polarisations count as vertical, which is diffracted more strongly.
LinearPolarization linearPolarization(Polarization polarization);

/// Electrical constants of a ground: relative permittivity eps' - i eps'' with eps'' = sigma / (2 pi f eps0).
struct GroundConstants {
  double relative_permittivity = 22;
  double conductivity_s_per_m = 0.003;

  /// eps'' at a frequency (Hz).
  EMSCAPE_HD double lossFactor(double frequency_hz) const {
    return conductivity_s_per_m * kSiemensPerMetreToLoss_hz / frequency_hz;
  }
  /// 1 / (2 pi eps0), approximated by 18 GHz / (S/m) in recommendations.
  static constexpr double kSiemensPerMetreToLoss_hz = 1.79751e10;
};

/// The constants of land and sea of P.526 for the spherical earth.
constexpr GroundConstants kDiffractionLand{22, 0.003};
constexpr GroundConstants kDiffractionSea{80, 5};

/// Constants of a kind of ground at a frequency. Waters by P.527 at 15 degrees (sea water of 35 g/kg): the
/// conductivity includes the dielectric relaxation loss and increases with frequency. Land has one pair of
/// constants for all frequencies (wet 25 and 0.02 S/m, average 15 and 0.005, dry 4 and 0.001; the NTIA's
/// figures for ITM; concrete 5.3 and 0.1, P.2040 at 3 GHz): above about 10 GHz its loss is underestimated.
GroundConstants groundConstants(GroundKind kind, double frequency_hz);
/// The constants given for a ground; for the others, those of its kind.
GroundConstants groundConstants(const Ground& ground, double frequency_hz);

/// Water at a temperature (degrees Celsius, -4..40) and salinity (g/kg, 0..40); frequency up to 1000 GHz.
/// @see P.527-6 section 5.1: eq. (4) to (8) without, (10) to (25) with salt
GroundConstants waterConstants(double frequency_hz, double temperature_c, double salinity_g_per_kg);

}  // namespace emscape::propagation
