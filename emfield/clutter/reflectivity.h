/// Reflectivity of sea, land and rain: mean radar cross section per unit area or volume.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "emscape/propagation/settings.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// The five constants of the sea model for a polarisation.
struct SeaConstants {
  double c1 = 0, c2 = 0, c3 = 0, c4 = 0, c5 = 0;
};
EMSCAPE_HD constexpr SeaConstants seaConstants(bool is_horizontal) {
  return is_horizontal ? SeaConstants{-73.0, 20.781, 7.351, 25.65, 0.0054}
                       : SeaConstants{-50.796, 25.93, 0.7093, 21.588, 0.00211};
}

/// Mean reflectivity of the sea (dB, m2 per m2), including propagation near the surface:
///   c1 + c2 log sin a + (27.5 + c3 a) log f / (1 + 0.95 a) + c4 (1 + s)^(1 / (2 + 0.085 a + 0.033 s)) + c5
///   a^2,
/// a the grazing angle in degrees, f in GHz, s the sea state.
/// @param sine       of the grazing angle, > 0: 0.1 to 60 degrees; the formula is continued outside
/// @param sea_state  0..6
/// @param frequency_ghz  0.5 to 35
/// @accuracy mean deviation from Nathanson's tables 2.6 dB (H), 2.5 dB (V)
/// @see V. Gregers-Hansen, R. Mital, An Improved Empirical Model for Radar Sea Clutter Reflectivity,
/// NRL/MR/5310-12-9346, 2012, and IEEE Trans. AES-48 (2012), p. 3512
EMSCAPE_HD inline double seaReflectivityDb(const SeaConstants& c, double frequency_ghz, double sea_state,
                                           double sine) {
  const double angle_deg = radToDeg(std::asin(sine < 1 ? sine : 1.0));
  return c.c1 + c.c2 * std::log10(sine) +
         (27.5 + c.c3 * angle_deg) * std::log10(frequency_ghz) / (1 + 0.95 * angle_deg) +
         c.c4 * std::pow(1 + sea_state, 1 / (2 + 0.085 * angle_deg + 0.033 * sea_state)) +
         c.c5 * angle_deg * angle_deg;
}

/// The surface at a point.
struct SurfaceFace {
  bool is_sea = false;
  double gamma = 0;  ///< of land
};

/// The land and the sea below a radar, as plain data.
struct SurfaceEcho {
  bool has_land = false, has_sea = false;
  double gamma = 0;       ///< of land: sigma0 = gamma sin(grazing angle)
  bool by_cover = false;  ///< gamma holds where the land cover names no kind of land
  double gamma_of_kind[namesOf(scenario::LandKind()).size()] = {};
  double sea_state = 0, frequency_ghz = 0;
  double horizontal_part = 0;  ///< fraction 0..1 of the wave's power; the cross section of the sea is the
                               ///< weighted mean of both polarisations

  /// Mean radar cross section per unit area.
  /// @param sine  of the grazing angle; <= 0: a face that is turned away, for which the result is 0
  EMSCAPE_HD double reflectivity(const SurfaceFace& face, double sine) const {
    if (!(sine > 0)) return 0;
    if (!face.is_sea) return has_land ? face.gamma * sine : 0;
    if (!has_sea) return 0;
    const double vertical_part = 1 - horizontal_part;
    return (horizontal_part > 0 ? horizontal_part * seaReflectivity(true, sine) : 0) +
           (vertical_part > 0 ? vertical_part * seaReflectivity(false, sine) : 0);
  }
  /// Ground at or below mean sea level is sea where there is sea.
  EMSCAPE_HD SurfaceFace faceOn(float ground_msl_m) const { return {has_sea && ground_msl_m <= 0, gamma}; }
  /// By the land cover: all water has the echo of the sea.
  EMSCAPE_HD SurfaceFace faceOn(const scenario::CoverValues& cover) const {
    return {cover.zone != scenario::CoverZone::land,
            by_cover && cover.kind >= 0 ? gamma_of_kind[cover.kind] : gamma};
  }

 private:
  EMSCAPE_HD double seaReflectivity(bool is_horizontal, double sine) const {
    return std::pow(10.0,
                    seaReflectivityDb(seaConstants(is_horizontal), frequency_ghz, sea_state, sine) / 10);
  }
};

/// Part of a wave's power that is horizontally polarised.
inline double horizontalPart(propagation::Polarization polarization) {
  using propagation::Polarization;
  return polarization == Polarization::horizontal ? 1 : polarization == Polarization::vertical ? 0 : 0.5;
}

/// Reflectivity of rain (m2 per m3): drops much smaller than the wavelength,
///   eta = pi^5 |K|^2 Z / lambda^4, |K|^2 = 0.93, Z = 200 R^1.6 mm6/m3.
/// @param rain_mm_h  R, >= 0
/// @param frequency_hz  up to about 10 GHz
/// @see J. S. Marshall, W. M. Palmer, J. Meteorology 5 (1948), p. 165, for Z; M. I. Skolnik, Introduction to
/// Radar Systems, 2nd ed., section 13.7, for eta
inline double rainReflectivity_m2_m3(double rain_mm_h, double frequency_hz) {
  if (!(rain_mm_h > 0)) return 0;
  const double lambda_m = wavelength_m(frequency_hz);
  const double z_m3 = 200 * std::pow(rain_mm_h, 1.6) * 1e-18;
  return std::pow(kPi, 5) * 0.93 * z_m3 / std::pow(lambda_m, 4);
}

}  // namespace emscape::emfield
