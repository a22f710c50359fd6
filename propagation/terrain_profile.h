/// Terrain along a path, input of the models.
#pragma once

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// Land cover of a post over the sea, in place of a height.
constexpr float kSeaCover = -1;

/// Times the distance of the receivers: the largest range of a post between. Nearer ones would be at the
/// receivers in float.
constexpr double kBeforeReceivers = 1 - 3e-7;

/// Terrain along a path: `count` posts, ranges increasing from 0 at the transmitter; two posts in
/// between may be at the same range, up to rounding.
struct TerrainProfile {
  const double* range_m = nullptr;
  const float* height_msl_m = nullptr;
  int count = 0;
  /// Land cover: the height of the clutter on land, kSeaCover over the sea, NaN where it is unknown; null:
  /// unknown everywhere.
  const float* cover_m = nullptr;
  /// Heights of the ground, where those of height_msl_m are raised by clutter; null: they are not.
  const float* bare_msl_m = nullptr;

  /// The part of the profile up to a post.
  EMSCAPE_HD TerrainProfile upTo(int last) const {
    return {range_m, height_msl_m, last + 1, cover_m, bare_msl_m};
  }
  EMSCAPE_HD const float* ground_msl_m() const { return bare_msl_m != nullptr ? bare_msl_m : height_msl_m; }

  EMSCAPE_HD bool hasCover(int post) const { return cover_m != nullptr && cover_m[post] == cover_m[post]; }
  /// By the land cover; where it is unknown, ground at or below mean sea level.
  EMSCAPE_HD bool isSea(int post) const {
    return hasCover(post) ? cover_m[post] < 0 : height_msl_m[post] <= 0;
  }
  /// Height of the clutter. @param otherwise_m  where the land cover is unknown
  template <class Real>
  EMSCAPE_HD Real clutter_m(int post, Real otherwise_m) const {
    return !hasCover(post) ? otherwise_m : cover_m[post] > 0 ? Real(cover_m[post]) : Real(0);
  }
};

}  // namespace emscape::propagation
