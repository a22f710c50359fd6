/// Stage 1: terrain heights along azimuths from an emitter, read once from the elevation model.
#pragma once

#include <vector>

#include "emfield/fan_coordinates.h"
#include "scenario/terrain.h"

namespace emscape::emfield {

/// Azimuths first_azimuth_rad + a * azimuth_step_rad, the same ranges along each. Immutable once made.
struct TerrainFan {
  double first_azimuth_rad = 0;
  double azimuth_step_rad = 0;
  int azimuth_count = 0;
  bool full_circle = false;  ///< the azimuth after the last one is the first
  /// From 0 (the station) outwards: dense near it, where a few metres of ground hide much of the sky.
  std::vector<double> ranges_m;
  /// Height above mean sea level (m), azimuth_count x rangeCount(), range fastest; NaN over missing terrain
  /// and beyond used_ranges.
  std::vector<float> height_msl_m;
  /// For each azimuth the number of ranges that a column of the grid lies behind; 0: none.
  std::vector<int> used_ranges;

  const float* profile(int azimuth) const {
    return height_msl_m.data() + static_cast<std::size_t>(azimuth) * rangeCount();
  }
  int rangeCount() const { return static_cast<int>(ranges_m.size()); }
  /// Index of the last sample nearer than a range; 0 if there is none.
  int lastBefore(double range_m) const;
  /// Fractional azimuth index, 0 <= index < azimuth_count; the neighbours of floor(index) are next().
  double azimuthIndex(double azimuth_rad) const;
  int next(int azimuth) const {
    return azimuth + 1 < azimuth_count ? azimuth + 1 : (full_circle ? 0 : azimuth);
  }
};

/// Distances between the samples of a fan: the azimuths' at the farthest column, and along a range away from
/// the station (m).
struct FanResolution {
  double arc_m = 0;
  double range_m = 0;
};

/// Resolution at which no post of the terrain is passed over, but no finer than an eighth (along a range: a
/// sixteenth) of a voxel.
FanResolution fanResolution(const volume::Grid& grid, const scenario::Terrain* terrain);

/// The fan that reaches every column: a full circle, or the sector that holds the grid for a station well
/// outside it.
/// @param terrain  null: a smooth earth at mean sea level, one azimuth serves all
/// @param lean_m  how far (m) a point may lie off its column's middle; 0 for upright columns
TerrainFan makeTerrainFan(const Station& station, const std::vector<FanCoordinates>& coordinates,
                          const scenario::Terrain* terrain, const FanResolution& resolution, double lean_m);

}  // namespace emscape::emfield
