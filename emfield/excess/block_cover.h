/// Clutter heights along a short straight part of a path.
#pragma once

#include "emfield/ground/read_cover.h"

namespace emscape::emfield {

/// A part of a path in columns and rows of the finest raster, from its begin by a length.
struct RasterLine {
  double column, row, column_length, row_length;
  float first_m, length_m;  ///< ranges
};

/// Adds clutter to posts as raiseByClutter() does. The path is beside that of its profile by some
/// millimetres: where that may decide on the class of the ground, the higher clutter is taken.
class BlockCover {
 public:
  static constexpr int kPosts = 16;  ///< most posts of a part

  /// @param terrain  with rasters and clutter; must outlive this object
  explicit BlockCover(const scenario::TerrainView& terrain);

  /// @param columns     number of posts on columns of the raster, the first ones
  /// @param crossings   the same with those on rows, the next ones
  /// @param count       of all posts
  /// @param distance_m  of the path
  /// @param beside_m    largest distance from the profile's path
  /// @param base_msl_m  to which heights are relative
  /// @param height_m    kPosts, of which `count` are raised. Posts at -infinity are none
  /// @return bit i: the height of post i is an upper bound
  unsigned raise(const RasterLine& line, int columns, int crossings, int count, float distance_m,
                 float beside_m, float base_msl_m, const float* range_m, float* height_m) const;

 private:
  std::uint8_t cellAt(int column, int row) const;
  float heightOf(std::uint8_t cell, float surface_m) const;
  float surface_m(const RasterLine& line, float part, float ground_msl_m) const;

  const scenario::TerrainView& terrain_;
  ClassCovers classes_;
  /// Of the land cover's cells: that of the raster's first post, their number per post and per metre, and in
  /// 360 degrees.
  double first_column_ = 0, first_row_ = 0, per_column_ = 0, per_row_ = 0, turn_cells_ = 1;
  float columns_per_m_ = 0, rows_per_m_ = 0;
};

}  // namespace emscape::emfield
