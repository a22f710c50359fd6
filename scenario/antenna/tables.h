/// Tables of patterns, and the antennas that use them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "emscape/scenario/antenna/antenna.h"

namespace emscape::scenario {

/// Signed amplitude by an angle (rad) or a direction cosine.
using Shape = std::function<double(double)>;

/// Largest number of intervals of a table of one variable: 1 MiB of floats.
constexpr int kMaxIntervals = 1 << 18;

/// A shape sampled uniformly over -half_span..half_span, including both ends and 0.
struct ShapeTable {
  Shape shape;
  double half_span = 0;
  std::vector<float> values;  ///< odd number

  int count() const { return static_cast<int>(values.size()); }
};
/// @param largest_step  > 0; increased if more than kMaxIntervals intervals would be needed
ShapeTable tabulate(Shape shape, double half_span, double largest_step);
/// The same with samples at every one of the angles (deg), if they are multiples of 0.0001 degree and the
/// intervals suffice.
ShapeTable tabulate(Shape shape, double half_span, const std::vector<double>& angles_deg);

/// The number of intervals, even and at most `most`, that divides a span (deg) so that every angle is an end
/// of an interval. If that needs too many, or angles are not multiples of 0.0001 degree: at least eight
/// intervals per smallest distance of two angles.
/// @param angles_deg  counted from the span's middle, ascending
int intervalsThatMeet(const std::vector<double>& angles_deg, double span_deg, int most);

/// Distance between the half-power points to both sides of a table's maximum, in the unit of half_span; 2
/// half_span if there are none on either side.
/// @param closed  the table's ends coincide (azimuth)
double halfPowerWidth(const std::vector<float>& values, double half_span, bool closed);

/// Azimuth and elevation of a direction (forward, right, up); azimuth 0 at the poles.
struct Angles {
  double azimuth_rad;
  double elevation_rad;
};
Angles patternAngles(const Vec3d& direction);

/// PatternView::lobe_tangent of a pattern that is at its side-lobe level beyond an azimuth (rad) to both
/// sides.
float lobeTangent(double edge_azimuth_rad);

/// azimuth shape * elevation shape, at least side_lobe_amplitude.
class SeparableAntenna : public Antenna {
 public:
  SeparableAntenna(ShapeTable azimuth, ShapeTable elevation, double side_lobe_amplitude);
  PatternView view() const override;
  double signedAmplitudeTowards(const Vec3d& direction, double steer_u, double steer_v) const override;

 private:
  ShapeTable azimuth_, elevation_;
  double side_lobe_amplitude_;
  float lobe_tangent_;
};

/// Rows of elevation from -90 to 90 degrees, azimuth fastest from -180 to 180; bilinear in amplitude.
class GridAntenna : public Antenna {
 public:
  /// @param amplitudes  azimuth_count * elevation_count, both odd and at least 3
  /// @param side_lobe_amplitude  lower limit of the pattern
  GridAntenna(std::vector<float> amplitudes, int azimuth_count, int elevation_count,
              float side_lobe_amplitude = 0);
  PatternView view() const override;
  double signedAmplitudeTowards(const Vec3d& direction, double steer_u, double steer_v) const override;

 private:
  std::vector<float> amplitudes_;
  int azimuth_count_, elevation_count_;
  float side_lobe_amplitude_;
};

/// Largest number of intervals of a grid in azimuth, twice that in elevation: 0.1 degree, 26 MB.
constexpr int kMaxGridIntervals = 3600;

/// Angles (deg) of a grid's entries: azimuths from -180 to 180, elevations from -90 to 90, evenly spaced.
struct GridNodes {
  std::vector<double> azimuths_deg, elevations_deg;
};
/// Nodes at the angles of a measurement (ascending), as intervalsThatMeet().
GridNodes gridNodes(const std::vector<double>& azimuths_deg, const std::vector<double>& elevations_deg);

/// @param amplitudes  at the nodes, azimuth fastest
/// The beamwidths are measured through the maximum.
AntennaPtr makeGridAntenna(const GridNodes& nodes, std::vector<float> amplitudes, double gain_dbi,
                           const std::string& name);

/// Completes an antenna: gain, beamwidths, and a description that names them.
AntennaPtr describedAntenna(const std::shared_ptr<Antenna>& antenna, double gain_dbi, double beamwidth_az_deg,
                            double beamwidth_el_deg, const std::string& name);

constexpr double kMaxGain_dbi = 100;
/// @throws Error (bad_input) unless -kMaxGain_dbi <= gain_dbi <= kMaxGain_dbi
void requireGain(double gain_dbi);
/// @throws Error (bad_input) unless low <= value <= high; names the value, the range and the unit
void requireWithin(const char* name, double value, double low, double high, const char* unit);

}  // namespace emscape::scenario
