/// Two-way power of a radar's beam for clutter, from cuts of its antenna's pattern.
#pragma once

#include <memory>

#include "base/math/fast_math.h"
#include "emscape/base/host_device.h"
#include "emscape/scenario/antenna/antenna.h"

namespace emscape::emfield {

/// Part of a beam's two-way power that is below an elevation, by the angle from its axis: log2(part / (1 -
/// part)), which is smooth far into the side lobes, evenly spaced from -reach_rad to reach_rad.
struct PowerBelow {
  static constexpr int kNodes = 65;
  float reach_rad = 1;
  float log2_odds[kNodes] = {};

  EMSCAPE_HD float at(float from_axis_rad) const {
    const float node = (from_axis_rad / reach_rad + 1) * (0.5f * (kNodes - 1));
    const float inside = node > 0 ? node : 0.0f;
    const float bounded = inside < kNodes - 1 ? inside : kNodes - 1.0f;
    const int below = static_cast<int>(bounded < kNodes - 2 ? bounded : kNodes - 2.0f);
    const float odds = log2_odds[below] + (bounded - below) * (log2_odds[below + 1] - log2_odds[below]);
    return 1 / (1 + fastExp2(-odds));
  }
};

/// Parts of a beam's two-way power in the rows of a map about its axis, by the azimuth cut of the pattern;
/// their sum is 1. Rows within 1.5 half-power widths: of a Gaussian beam, to 54 dB below the maximum.
struct PowerBeside {
  static constexpr int kMaxBeside = 44;
  int beside = 0;                         ///< rows on each side
  float parts[2 * kMaxBeside + 1] = {1};  ///< from the most anticlockwise row on
};

/// Integral over a cut of the pattern's two-way power, 1 at its maximum: the widths of the beam for clutter.
/// Gaussian beams: 0.753 of the half-power width, (pi / (8 ln 2))^(1/2), as in J. R. Probert-Jones, Q. J. R.
/// Meteorol. Soc. 88 (1962), p. 485.
struct ClutterBeam {
  double azimuth_rad = 0;  ///< at the elevation of the maximum; 2 pi for an isotropic antenna
  double elevation_rad =
      0;             ///< at azimuth 0, weighted by the cosine of the elevation; 2 for an isotropic antenna
  PowerBelow below;  ///< of the same cut
  PowerBeside beside;
};
ClutterBeam clutterBeam(const scenario::Antenna& antenna);
/// The same, computed once as long as the antenna exists. Threads may share it.
std::shared_ptr<const ClutterBeam> clutterBeamOf(const scenario::AntennaPtr& antenna);

/// Azimuths of a radar's map of clutter: four per half-power width, 90 to 1440.
int clutterAzimuths(const scenario::Antenna& antenna);

}  // namespace emscape::emfield
