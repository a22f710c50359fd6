/// Upper bounds of the ground along short parts of paths, from one lookup each: searches for the obstacle
/// that decides leave out the parts that are too low.
#pragma once

#include <cmath>
#include <vector>

#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// Maxima over windows of the posts of the finest raster, one window every kStride posts in each direction.
/// Immutable once made.
class TerrainBounds {
 public:
  static constexpr int kStride = 4;
  /// Largest extent (posts, in rows and in columns) of a part of a path.
  static constexpr float kMaxExtent = 9;

  explicit TerrainBounds(const scenario::TerrainView& terrain);

  /// True if positions in the raster (posts) are precise enough as float.
  bool isUsable() const { return !highest_msl_m_.empty(); }
  /// Number of windows of a row.
  int rowWindows() const { return windows_; }
  /// One per window, rows one after another: the highest post (m); infinity if one is void. Window (i, j)
  /// holds every part of a path that begins at column i kStride..(i + 1) kStride and row j kStride..(j + 1)
  /// kStride, these being its lowest, and extends by no more than kMaxExtent.
  const float* highest_msl_m() const { return highest_msl_m_.data(); }
  /// Upper bound of the ground's slope (m per m) in any direction; infinity if it is not known.
  double steepest() const { return steepest_; }

 private:
  int windows_ = 0;
  std::vector<float> highest_msl_m_;
  double steepest_ = HUGE_VAL;
};

}  // namespace emscape::emfield
