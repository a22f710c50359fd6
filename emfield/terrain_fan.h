/// Stage 1: terrain heights along azimuths from an emitter, read once from the elevation model.
#pragma once

#include <cmath>
#include <vector>

#include "emfield/fan_coordinates.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "emscape/scenario/terrain.h"

namespace emscape::emfield {

/// Distances (m) between the samples of a fan: between azimuths at the farthest column, and along the range
/// far from the station.
struct FanResolution {
  double arc_m = 0;
  double range_m = 0;
};

/// The spacing of the terrain's posts, but not finer than an eighth (along the range: a sixteenth) of a
/// voxel.
FanResolution fanResolution(const volume::Grid& grid, const scenario::Terrain* terrain);

/// The shape of a fan as plain data, for loops on host and device; see FanShape.
struct FanView {
  double first_azimuth_rad = 0;
  double azimuth_step_rad = 0;
  int interval_count = 1;
  bool full_circle = false;
  const double* ranges_m = nullptr;
  int range_count = 0;

  /// Fractional azimuth index, 0 <= index < interval_count; outside a sector its nearest border.
  EMSCAPE_HD double azimuthIndex(double azimuth_rad) const {
    if (azimuth_step_rad == 0) return 0;
    double offset = std::remainder(azimuth_rad - first_azimuth_rad, 2 * kPi);
    if (offset < 0) offset = full_circle ? offset + 2 * kPi : 0;
    const double index = offset / azimuth_step_rad;
    if (index < interval_count) return index;
    return full_circle ? 0 : std::nextafter(static_cast<double>(interval_count), 0.0);
  }
  /// Index of the last sample nearer than a range; 0 if there is none.
  EMSCAPE_HD int lastBefore(double range_m) const {
    int begin = 0, end = range_count;  // the first that is not nearer
    while (begin < end) {
      const int middle = (begin + end) / 2;
      if (ranges_m[middle] < range_m) {
        begin = middle + 1;
      } else {
        end = middle;
      }
    }
    return begin > 0 ? begin - 1 : 0;
  }
};

/// The positions of a fan's samples: azimuths first_azimuth_rad + a * azimuth_step_rad for a =
/// 0..interval_count, the same ranges along each. Immutable once made.
struct FanShape {
  double first_azimuth_rad = 0;
  double azimuth_step_rad = 0;
  int interval_count = 1;    ///< between azimuths
  bool full_circle = false;  ///< the last azimuth is the first one again
  /// From 0 (the station) outwards: dense near it, where a few metres of ground mask a large angle.
  std::vector<double> ranges_m;
  /// For each azimuth the number of ranges nearer than some column of the grid; 0: none.
  std::vector<int> used_ranges;

  int rangeCount() const { return static_cast<int>(ranges_m.size()); }
  /// Valid as long as this object lives.
  FanView view() const {
    return {first_azimuth_rad, azimuth_step_rad, interval_count, full_circle, ranges_m.data(), rangeCount()};
  }
};

/// Ranges of a fan's samples, from 0 to the first one not below farthest_m: every few metres at first, then
/// in proportion to the range, then evenly.
std::vector<double> fanRanges(double farthest_m, double even_step_m);

/// The fan that reaches every column: a full circle, or the sector of the grid for a station well outside it.
/// @param terrain  null: a smooth earth, with one interval for all azimuths
/// @param tilt_m  tiltOf(): largest ground distance (m) of a point from its column's middle
FanShape fanShape(const Station& station, const std::vector<FanCoordinates>& coordinates,
                  const scenario::Terrain* terrain, const FanResolution& resolution, double tilt_m);

/// Heights of some neighbouring intervals of a fan.
struct TerrainFan {
  int first_interval = 0;
  int interval_count = 0;
  int range_count = 0;
  /// Height above mean sea level (m), (interval_count + 1) azimuths x range_count, range fastest; NaN over
  /// missing terrain and beyond used_ranges.
  std::vector<float> height_msl_m;
};

/// @param terrain  null: a smooth earth at mean sea level
TerrainFan readTerrainFan(const Station& station, const FanShape& shape, const scenario::Terrain* terrain,
                          int first_interval, int interval_count);

}  // namespace emscape::emfield
