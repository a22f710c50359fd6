/// Amplitude taper of an aperture or of a line of array elements: its pattern, width and efficiency.
#pragma once

#include <array>
#include <vector>

#include "emscape/base/enum_names.h"

namespace emscape::scenario {

using emscape::toString;

enum class TaperKind {
  uniform,  ///< constant amplitude: first side lobe -13.26 dB
  taylor,   ///< n-bar side lobes at a chosen level, lower ones beyond
  cosine    ///< half a cosine, 0 at the edges: first side lobe -23.0 dB
};
constexpr auto namesOf(TaperKind) {
  return std::array{"uniform", "taylor", "cosine"};
}

/// An amplitude distribution 1 + 2 sum(F_m cos(2 pi m x)), or cos(pi x), over an aperture x = -1/2..1/2. The
/// pattern variable is u = (side / wavelength) * direction cosine. Immutable.
/// @see T. T. Taylor, "Design of line-source antennas for narrow beamwidth and low side lobes", IRE Trans.
/// AP-3 (1955); Balanis, Antenna Theory, 4th ed., 7.6 and table 12.1
class Taper {
 public:
  /// @param side_lobe_db  Taylor's design level, below the maximum: -60..-15; others ignore it. n-bar is the
  ///                      smallest that gives a monotonic distribution, ceil(2 A^2 + 1/2), pi A =
  ///                      arcosh(10^(-side_lobe_db / 20))
  explicit Taper(TaperKind kind = TaperKind::uniform, double side_lobe_db = -30);

  TaperKind kind() const { return kind_; }
  /// Pattern of a continuous aperture, signed amplitude, 1 at u = 0.
  double pattern(double u) const;
  /// Pattern of `elements` evenly spaced elements whose weights are the distribution at their centres,
  /// x = (i - (elements - 1) / 2) / elements: signed amplitude, 1 at the main lobe.
  /// @param phase_rad  pi * spacing in wavelengths * direction cosine
  double arrayPattern(int elements, double phase_rad) const;
  /// u at which pattern() has fallen to half power; 0.443 for `uniform`.
  double halfPower() const { return half_power_; }
  /// Directivity of `elements` with these weights relative to uniform weights, (sum w)^2 / (N sum w^2): 0..1.
  double arrayEfficiency(int elements) const;

 private:
  double weight(double x) const;

  TaperKind kind_;
  std::vector<double> harmonics_;  ///< F_1 .. F_(n-bar - 1); only for Taylor
  double half_power_;
};

}  // namespace emscape::scenario
