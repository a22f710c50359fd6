/// The ground as plain data, for loops on host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "emscape/scenario/terrain/land_cover.h"
#include "propagation/terrain_profile.h"

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

/// Values of a class of the land cover.
struct CoverValues {
  bool is_known = false;
  float clutter_height_m = 0;
  CoverZone zone = CoverZone::land;
  int kind = -1;  ///< LandKind; -1: none
};

/// Classes of the land cover, south row first, west cell first.
struct LandCoverView {
  static constexpr std::uint8_t kNoClass = 255;

  const std::uint8_t* cells = nullptr;  ///< indices of `classes`, >= class_count: none; null: no land cover
  int columns = 0, rows = 0;
  double south_rad = 0, west_rad = 0;  ///< of the outer edges
  double cells_per_rad_lat = 0, cells_per_rad_lon = 0;
  const CoverValues* classes = nullptr;
  int class_count = 0;

  EMSCAPE_HD bool isSet() const { return cells != nullptr; }
  /// The class of the cell at a point; -1: none is known.
  EMSCAPE_HD int classAt(double latitude_rad, double longitude_rad) const {
    const double row = std::floor((latitude_rad - south_rad) * cells_per_rad_lat);
    double column = (longitude_rad - west_rad) * cells_per_rad_lon;
    const double turn = 2.0 * kPi * cells_per_rad_lon;
    column = std::floor(column - turn * std::floor(column / turn));
    if (!(row >= 0 && row < rows && column >= 0 && column < columns)) return -1;
    const int found = cells[static_cast<long long>(row) * columns + static_cast<long long>(column)];
    return found < class_count ? found : -1;
  }
  EMSCAPE_HD CoverValues valuesAt(double latitude_rad, double longitude_rad) const {
    const int found = isSet() ? classAt(latitude_rad, longitude_rad) : -1;
    return found >= 0 ? classes[found] : CoverValues{};
  }
};

/// All rasters of a terrain, the finest first. Valid as long as the Terrain that returned it. For a device,
/// copy the rasters' heights there and set the pointers in a copy of the array.
struct TerrainView {
  const TerrainRaster* rasters = nullptr;
  int count = 0;
  const TerrainRaster* surfaces = nullptr;  ///< of a surface model, whose trees and buildings are clutter
  int surface_count = 0;
  LandCoverView cover = {};

  /// Height above mean sea level (m): of the finest raster with a height at the position; NaN if there is
  /// none.
  /// @param latitude_rad  -pi/2..pi/2, longitude_rad any
  EMSCAPE_HD float heightAt(double latitude_rad, double longitude_rad) const {
    return heightAmong(rasters, count, latitude_rad, longitude_rad);
  }

  /// The same of the surface model.
  EMSCAPE_HD float surfaceAt(double latitude_rad, double longitude_rad) const {
    return heightAmong(surfaces, surface_count, latitude_rad, longitude_rad);
  }

  /// True if coverAt() may be known.
  EMSCAPE_HD bool hasCover() const { return cover.isSet() || surface_count > 0; }
  /// The land cover at a point as an element of TerrainProfile::cover_m.
  EMSCAPE_HD float coverAt(double latitude_rad, double longitude_rad, float ground_msl_m) const {
    const CoverValues values = cover.valuesAt(latitude_rad, longitude_rad);
    const bool is_sea = values.zone == CoverZone::sea ||
                        (values.zone == CoverZone::water && ground_msl_m <= LandCover::kMaxSea_m);
    if (is_sea) return propagation::kSeaCover;
    if (values.zone == CoverZone::water) return 0;
    const float above_m = surfaceAt(latitude_rad, longitude_rad) - ground_msl_m;
    if (above_m == above_m) return above_m > 0 ? above_m : 0;
    return values.is_known ? values.clutter_height_m : NAN;
  }

 private:
  EMSCAPE_HD static float heightAmong(const TerrainRaster* among, int number, double latitude_rad,
                                      double longitude_rad) {
    float height = NAN;
    for (int k = 0; k < number && !(height == height); ++k) {
      height = among[k].heightAt(latitude_rad, longitude_rad);
    }
    return height;
  }
};

}  // namespace emscape::scenario
