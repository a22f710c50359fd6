/// Clutter of a radar: the echoes of land, sea and rain, and the Doppler filter that suppresses them.
#pragma once

#include <array>
#include <optional>

#include "emscape/base/enum_names.h"
#include "emscape/scenario/terrain/land_cover.h"

namespace emscape::scenario {

using emscape::toString;

/// Gamma (dB) of a kind of land: its value at 10 GHz + 5 log10(f / 10 GHz).
double landGammaDb(LandKind kind, double frequency_hz);

/// Doppler filter of a pulse train.
enum class MtiKind {
  canceller,     ///< delay-line canceller: binomial weights of alternating sign
  pulse_doppler  ///< weighted coherent sum of pulses, in the Doppler filter of the target
};
constexpr auto namesOf(MtiKind) {
  return std::array{"canceller", "pulse_doppler"};
}

struct Mti {
  MtiKind kind = MtiKind::canceller;
  int pulses = 2;  ///< pulses in the filter, >= 2
  /// Standard deviations (m/s) of the clutter's radial velocities; their spectra are Gaussian.
  double surface_spread_mps = 0;
  double rain_spread_mps = 0;
  std::optional<double> improvement_limit_db;  ///< by the radar's instability; none: no limit

  /// Pulses that leave the filter and are left to integrate: hits - N + 1 of a canceller, hits / N coherent
  /// sums of a pulse Doppler filter. Below 1: the hits do not fill the filter.
  /// @param hits  on a target in one pass of the beam, > 0
  double outputsOf(double hits) const;
};

/// At least one of land, sea and rain.
struct Clutter {
  std::optional<double> land_gamma_db;  ///< sigma0 of land over the sine of the grazing angle; none: no echo
  bool land_by_cover = false;    ///< land_gamma_db holds where the terrain's land cover names no kind of land
  std::optional<int> sea_state;  ///< 0..6; none: no echo
  bool rain = false;             ///< echo of the atmosphere's rain
  double range_cell_m = 0;       ///< length of the resolution cell after pulse compression, > 0
  /// Independent samples of the clutter among the pulses that are integrated; none: all of them.
  std::optional<int> independent_samples;
  std::optional<Mti> mti;
  /// Radial speed of the target in volumes, either sign; none: the mean response of all speeds (canceller),
  /// the middle between two blind speeds (pulse_doppler).
  std::optional<double> target_radial_speed_mps;

  bool hasSurface() const { return land_gamma_db || sea_state; }
};

}  // namespace emscape::scenario
