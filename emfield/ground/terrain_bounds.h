/// Upper bounds of the ground's slope along short parts of paths, by one lookup each. With the heights along
/// one path they give bounds of the heights beside it.
#pragma once

#include <vector>

#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// Maxima over windows of the cells between the posts of the finest raster, one window every kStride posts in
/// each direction. Immutable once made.
class TerrainBounds {
 public:
  static constexpr int kStride = 4;
  /// Largest extent (posts, in rows and in columns) of a part of the ground.
  static constexpr float kMaxExtent = 7;

  explicit TerrainBounds(const scenario::TerrainView& terrain);

  /// True if the bounds are known: there is a raster, not too close to a pole, and small enough for precise
  /// positions (posts) in float.
  bool isUsable() const { return !steepest_.empty(); }
  /// Number of windows of a row.
  int rowWindows() const { return windows_; }
  /// One per window, rows one after another: an upper bound of the ground's slope (m per m) in any direction;
  /// infinity if a post is void. Window (i, j) contains every part of the ground that begins at column i
  /// kStride to (i + 1) kStride and row j kStride to (j + 1) kStride, these being its lowest, and extends by
  /// no more than kMaxExtent.
  const float* steepest() const { return steepest_.data(); }
  /// One per window: an upper bound of the clutter's height (m) in it; infinity if a post of the
  /// surface model is void. Null: there is no clutter, or it has
  /// no bounds because the surface model's posts are not those of the raster.
  const float* highestCover_m() const { return highest_cover_m_.empty() ? nullptr : highest_cover_m_.data(); }

 private:
  void boundCover(const scenario::TerrainView& terrain);

  int windows_ = 0;
  std::vector<float> steepest_, highest_cover_m_;
};

}  // namespace emscape::emfield
