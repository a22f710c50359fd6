/// A pattern on a grid that is fine in zones of each axis.
#pragma once

#include <vector>

#include "emscape/scenario/antenna/antenna.h"

namespace emscape::scenario {

/// Angles of a grid along one axis: multiples of a fine step in zones, of a coarse one elsewhere, and both
/// ends. They are whole units of 1/360 degree, so that a uniform table of positions by unit finds the
/// interval of an angle exactly.
class RefinedAxis {
 public:
  static constexpr int kUnitsPerDegree = 360;

  /// Zones of one axis.
  struct Zones {
    std::vector<double> middles_deg;
    double half_width_deg = 0;
    double step_deg = 0;  ///< rounded down to whole units, but at least one
  };
  /// @param half_span_deg  180 (azimuth, whose zones are continued at the other end) or 90 (elevation)
  /// @param coarse_step_deg  rounded down to a multiple of the fine step
  RefinedAxis(int half_span_deg, double coarse_step_deg, const Zones& zones);

  int count() const { return static_cast<int>(nodes_.size()); }
  double angle_deg(int i) const { return double(nodes_[static_cast<std::size_t>(i)]) / kUnitsPerDegree; }
  double fineStep_deg() const { return double(fine_) / kUnitsPerDegree; }
  /// By unit, from -half_span to half_span: the index of the node before it, and the part of the way to the
  /// next one.
  std::vector<float> positions() const;

 private:
  int half_span_, fine_;
  std::vector<int> nodes_;  ///< ascending
};

/// Rows of elevation, azimuth fastest; bilinear in amplitude between the nodes of two axes.
class RefinedGridAntenna : public Antenna {
 public:
  /// @param amplitudes  at the nodes
  /// @param side_lobe_amplitude  lower limit of the pattern
  RefinedGridAntenna(const RefinedAxis& azimuths, const RefinedAxis& elevations,
                     std::vector<float> amplitudes, float side_lobe_amplitude);
  PatternView view() const override;
  double signedAmplitudeTowards(const Vec3d& direction, double steer_u, double steer_v) const override;

 private:
  std::vector<float> azimuth_positions_, elevation_positions_, amplitudes_;
  int columns_, rows_;
  float side_lobe_amplitude_;
};

}  // namespace emscape::scenario
