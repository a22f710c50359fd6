/// Measured patterns: angles of measurement, and cuts.
#pragma once

#include <cstddef>
#include <vector>

#include "emscape/base/error.h"

namespace emscape::scenario {

/// Full circle (azimuths, whole vertical cuts) or elevations from -90 to 90 degrees.
enum class AxisKind { circle, elevation };

/// Two neighbours on an axis and a position between them.
struct AxisSample {
  std::size_t below = 0, above = 0;
  double fraction = 0;  ///< 0..1, from below to above
};

/// The distinct angles of a measurement, in ascending order: -180..180 (180 excluded) of a circle, or
/// -90..90.
class MeasuredAxis {
 public:
  /// Largest interpolated gap (deg) between neighbours.
  static constexpr double kMaxGap_deg = 90;

  /// @param angles_deg  in any order and number, each as returned by normalized()
  /// @param file, what  name the axis in errors
  /// @throws Error (bad_input) naming the gap if they do not cover the axis
  MeasuredAxis(AxisKind kind, std::vector<double> angles_deg, const SourceLocation& file, const char* what);

  /// An angle in the range of the kind and rounded to 1e-6 degree, so that equal angles are equal numbers.
  static double normalized(AxisKind kind, double angle_deg);

  const std::vector<double>& angles_deg() const { return angles_deg_; }
  /// Index of one of the axis's own angles.
  std::size_t indexOf(double normalized_deg) const;
  /// Position of any angle in the kind's range (circle: any angle).
  AxisSample locate(double angle_deg) const;

 private:
  AxisKind kind_;
  std::vector<double> angles_deg_;
};

/// One row of a measured cut.
struct CutRow {
  double angle_deg = 0;
  double attenuation_db = 0;  ///< below the maximum
  int line = 0, column = 0;   ///< of its text in the file
};

/// Amplitude by angle, linear in amplitude between the rows.
class MeasuredCut {
 public:
  /// @param rows  in any order
  /// @param file, what  name the cut in errors
  /// @throws Error (bad_input): for an angle with two attenuations, or as MeasuredAxis
  MeasuredCut(AxisKind kind, std::vector<CutRow> rows, const SourceLocation& file, const char* what);

  /// Amplitude (relative voltage, 0..1) at any angle of the axis.
  double amplitudeAt(double angle_deg) const;
  /// Attenuation (dB) there.
  double attenuationAt_db(double angle_deg) const;
  const std::vector<double>& angles_deg() const { return axis_.angles_deg(); }

 private:
  MeasuredAxis axis_;
  std::vector<double> amplitudes_;
};

/// Largest attenuation (dB) that files may contain.
constexpr double kMaxAttenuation_db = 300;

/// Relative voltage of an attenuation.
double amplitudeOfAttenuation(double attenuation_db);

/// @throws Error (bad_input) unless the smallest attenuation is within 1 dB of 0, as it must be for values
/// relative to the maximum
void requireMaximum(double smallest_attenuation_db, const SourceLocation& file, const char* what);

}  // namespace emscape::scenario
