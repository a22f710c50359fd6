/// The ground as plain data, for loops on host and device.
#pragma once

#include <cmath>

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"

namespace emscape::scenario {

/// One raster of posts, south row first, west post first; a void is NaN. Rows and columns are counted in
/// posts as real numbers: post (column, row) is at (column, row) exactly.
struct TerrainRaster {
  const float* heights_msl_m = nullptr;
  int columns = 0, rows = 0;           ///< >= 2 each
  double south_rad = 0, west_rad = 0;  ///< of post (0, 0); west within -2 pi..2 pi
  double posts_per_rad_lat = 0, posts_per_rad_lon = 0;
  /// Limits of lookups, within 0..columns - 1 and 0..rows - 1.
  double first_column = 0, last_column = 0, first_row = 0, last_row = 0;

  /// Tolerance (posts) beyond the limits, for rounded georeferences.
  static constexpr double kSlack = 1e-3;
  /// A void post with less weight than this is ignored.
  static constexpr float kNoWeight = 1e-6f;

  /// Clamps a point to the limits. False if it is beyond the tolerance.
  EMSCAPE_HD bool limit(double& column, double& row) const {
    if (!(column >= first_column - kSlack && column <= last_column + kSlack && row >= first_row - kSlack &&
          row <= last_row + kSlack)) {
      return false;
    }
    column = column < first_column ? first_column : column > last_column ? last_column : column;
    row = row < first_row ? first_row : row > last_row ? last_row : row;
    return true;
  }

  /// The point in posts, as real numbers; false if it is outside the raster.
  EMSCAPE_HD bool locate(double latitude_rad, double longitude_rad, double& column, double& row) const {
    row = (latitude_rad - south_rad) * posts_per_rad_lat;
    column = (longitude_rad - west_rad) * posts_per_rad_lon;
    if (limit(column, row)) return true;
    // The same meridian, shifted by 360 degrees.
    const double turn = 2.0 * kPi * posts_per_rad_lon;
    column -= turn * std::floor((column - first_column + kSlack) / turn);
    return limit(column, row);
  }

  /// Bilinear height (m) between posts, at a point within the limits; NaN if a post with weight is void.
  EMSCAPE_HD float heightAtPost(double column, double row) const {
    const int i = static_cast<int>(column) < columns - 2 ? static_cast<int>(column) : columns - 2;
    const int j = static_cast<int>(row) < rows - 2 ? static_cast<int>(row) : rows - 2;
    const float* south = heights_msl_m + static_cast<long long>(j) * columns + i;
    const float* north = south + columns;
    const float x = static_cast<float>(column - i);
    const float y = static_cast<float>(row - j);
    const float on_south = lerp(south[0], south[1], x);
    const float on_north = lerp(north[0], north[1], x);
    const float height = lerp(on_south, on_north, y);
    return height == height ? height : heightNextToVoid(south, north, x, y);
  }

  /// Bilinear height (m); NaN outside, or if a post with weight is void.
  EMSCAPE_HD float heightAt(double latitude_rad, double longitude_rad) const {
    double column, row;
    return locate(latitude_rad, longitude_rad, column, row) ? heightAtPost(column, row) : NAN;
  }

 private:
  /// The same if a post is void, which is ignored if it has no weight.
  EMSCAPE_HD static float heightNextToVoid(const float* south, const float* north, float x, float y) {
    const float weights[4] = {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
    const float posts[4] = {south[0], south[1], north[0], north[1]};
    float height = 0;
    for (int k = 0; k < 4; ++k) {
      if (weights[k] >= kNoWeight) height += weights[k] * posts[k];
    }
    return height;
  }
};

/// All rasters of a terrain, the finest first. Valid as long as the Terrain that returned it. For a device,
/// copy the rasters' heights there and set the pointers in a copy of the array.
struct TerrainView {
  const TerrainRaster* rasters = nullptr;
  int count = 0;

  /// Height above mean sea level (m): of the finest raster with a height at the position; NaN if there is
  /// none.
  /// @param latitude_rad  -pi/2..pi/2, longitude_rad any
  EMSCAPE_HD float heightAt(double latitude_rad, double longitude_rad) const {
    float height = NAN;
    for (int k = 0; k < count && !(height == height); ++k) {
      height = rasters[k].heightAt(latitude_rad, longitude_rad);
    }
    return height;
  }
};

}  // namespace emscape::scenario
