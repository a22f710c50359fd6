/// Clutter heights at posts of several paths.
#pragma once

#include "base/math/lanes.h"
#include "emfield/ground/read_cover.h"

namespace emscape::emfield {

/// Paths that are searched together, each in a vector lane.
constexpr int kPathLanes = 16;
using PathFloats = float __attribute__((vector_size(kPathLanes * sizeof(float))));
using PathInts = int __attribute__((vector_size(kPathLanes * sizeof(int))));

// Choices by bits: g++ 12 computes comparisons of vectors that are wider than the processor's one by one.

/// All bits of the lanes where a number is larger than another; none elsewhere. Not for two infinite ones.
inline void setAbove(const PathFloats& number, const PathFloats& other, PathInts& bits) {
  const PathFloats under = other - number;
  load(&under, bits);
  bits >>= 31;
}
/// `chosen` in the lanes of the bits, `otherwise` elsewhere.
inline void choose(const PathInts& bits, const PathFloats& chosen, const PathFloats& otherwise,
                   PathFloats& result) {
  PathInts a, b;
  load(&chosen, a);
  load(&otherwise, b);
  store(b ^ ((a ^ b) & bits), &result);
}

/// The lines between posts of the finest raster on which a post is.
enum class PostOn { column, row, neither };

/// A post of each of some paths, in columns and rows of the finest raster.
struct CoverTask {
  PostOn on;
  const float *range_m, *column, *row;  ///< relative to a corner
  const float *columns, *rows;          ///< by which the path goes on, over a short length
  const float *distance_m, *beside_m;   ///< of the paths; their largest distance from their profiles' paths
  int corner_column, corner_row;
  float base_msl_m;  ///< to which heights are relative
};

/// Adds clutter to posts as raiseByClutter() does. A path is beside that of its profile by some millimetres:
/// where that may decide on the class of the ground, the higher clutter is taken.
class BlockCover {
 public:
  /// @param terrain  with rasters and clutter; must outlive this object
  explicit BlockCover(const scenario::TerrainView& terrain);

  /// @param lanes  bit i: the height of path i is raised, unless it is -infinity
  /// @return bit i: the height of path i is an upper bound
  unsigned raise(const CoverTask& task, unsigned lanes, float* height_m) const;

 private:
  std::uint8_t cellAt(int column, int row) const;
  float heightOf(std::uint8_t cell, float surface_m) const;
  float surface_m(double column, double row, float ground_msl_m) const;

  const scenario::TerrainView& terrain_;
  ClassCovers classes_;
  /// Of the land cover's cells: that of the raster's first post, their number per post and per metre, and in
  /// 360 degrees.
  double first_column_ = 0, first_row_ = 0, per_column_ = 0, per_row_ = 0, turn_cells_ = 1;
  float columns_per_m_ = 0, rows_per_m_ = 0;
};

}  // namespace emscape::emfield
