/// Targets of radars, on platforms.
#pragma once

#include <memory>
#include <string>

namespace emscape::scenario {

/// Radar cross section by aspect. Immutable; shared by pointer.
class RcsTable {
 public:
  virtual ~RcsTable() = default;
  /// Radar cross section (dB over 1 m2), linear in dB between the rows of the table.
  /// @param azimuth_deg    of the radar as seen from the target, clockwise from the target's nose; any angle
  /// @param elevation_deg  above the plane of the target's wings, -90..90
  virtual double rcs_dbsm(double azimuth_deg, double elevation_deg) const = 0;
};
using RcsTablePtr = std::shared_ptr<const RcsTable>;

/// An object on a platform that radars may detect.
struct Target {
  std::string name;
  int platform = -1;  ///< index into Scenario::platforms
  double rcs_m2 = 1;  ///< for every aspect, unless there is a table
  RcsTablePtr table;  ///< may be null
  int swerling = 1;   ///< case of fluctuation, 0..4

  /// Radar cross section (m2) from an aspect; angles as for RcsTable.
  double rcsTowards_m2(double azimuth_deg, double elevation_deg) const;
};

/// Reads a table: CSV with the columns azimuth_deg, elevation_deg, rcs_dbsm in any order; a full grid that
/// covers the sphere with gaps of at most 90 deg, elevations from -90 to 90. Without elevation_deg the cross
/// section is the same at all elevations.
/// @throws Error (bad_input) with line and column
RcsTablePtr readRcsTable(const std::string& file);

}  // namespace emscape::scenario
