/// Noise that an antenna receives from the sky and the ground.
#pragma once

#include "emscape/propagation/settings.h"

namespace emscape::propagation {

/// Brightness temperature (K) of the clear sky: the galaxy, the cosmic background of 2.7 K and the radiation
/// of oxygen and water vapour (radiative transfer through the standard atmosphere). Without the sun, rain and
/// man-made noise.
/// Galaxy: P.372-16 eq. (13), Fam = 52 - 23 log f, up to 100 MHz; above by (f / 100 MHz)^-2.75 (P.372 Part
/// 4). Gases: P.676-13 line by line.
/// @param frequency_hz   1e6..1e12; below 10 MHz the shielding by the ionosphere is not taken into account
/// @param elevation_rad  0..pi/2 from sea level; below the horizon the result is that of the ground, 290 K
double skyTemperature_k(double frequency_hz, double elevation_rad, const Atmosphere& atmosphere);

/// Noise temperature (K) of an antenna: of a fraction of 0.876 of its pattern the mean of sky and ground over
/// the main beam, a Gaussian one about its elevation over a level horizon; of the rest, its side lobes, the
/// ground at 290 K. The fraction is that of Blake's T_a = (0.876 T_sky - 254) / L + 290 (citation not
/// checked).
/// @param elevation_rad  of the beam's axis, -pi/2..pi/2
/// @param beamwidth_rad  half-power width in elevation, > 0; taken as 60 degrees if it is more
double antennaTemperature_k(double frequency_hz, double elevation_rad, double beamwidth_rad,
                            const Atmosphere& atmosphere);

}  // namespace emscape::propagation
