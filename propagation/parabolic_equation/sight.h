/// Visibility of the ground between an antenna and a column.
#pragma once

#include <cmath>
#include <cstddef>

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// A post of the ground on the way from the antenna; heights are above mean sea level.
struct SightPost {
  float range_m, ground_m;
};

/// Memory for the posts of a column; those of several columns may be interleaved.
class SightPosts {
 public:
  SightPosts() = default;
  /// @param stride  from one post to the next
  EMSCAPE_HD SightPosts(float* range_m, float* ground_m, std::size_t stride = 1)
      : range_m_(range_m), ground_m_(ground_m), stride_(stride) {}

  EMSCAPE_HD SightPost get(int n) const {
    const std::size_t at = static_cast<std::size_t>(n) * stride_;
    return {range_m_[at], ground_m_[at]};
  }
  EMSCAPE_HD void set(int n, const SightPost& post) const {
    const std::size_t at = static_cast<std::size_t>(n) * stride_;
    range_m_[at] = post.range_m;
    ground_m_[at] = post.ground_m;
  }

 private:
  float *range_m_ = nullptr, *ground_m_ = nullptr;
  std::size_t stride_ = 1;
};

struct PeSight {
  /// Min distance (m); nearer, the slopes of the antenna's hill would dominate.
  static constexpr float kNearGround_m = 500;

  /// Largest angle (rad) above the horizontal at which the antenna sees the ground from kNearGround_m on, at
  /// least 0; NaN over missing terrain.
  float horizon_rad = 0;
  /// Largest angle (rad) from the antenna to the ground before the column, over the effective earth.
  float to_ground_rad = -HUGE_VALF;
  /// Posts before the column that are the horizon of some height there: the vertices of the upper convex hull
  /// of the ground over the effective earth, the nearest to the column last.
  SightPosts posts;
  int count = 0;

  EMSCAPE_HD bool isKnown() const { return horizon_rad == horizon_rad; }
};

/// Finds a PeSight in one pass over the posts.
class PeSightWalk {
 public:
  /// @param curvature_per_m  of rays over the flattened earth (PeOthers)
  /// @param half_curvature   of the effective earth
  /// @param range_m          of the column
  /// @param posts            as many as are added
  EMSCAPE_HD PeSightWalk(float tx_msl_m, float curvature_per_m, float half_curvature, float range_m,
                         const SightPosts& posts)
      : tx_msl_m_(tx_msl_m),
        curvature_per_m_(curvature_per_m),
        half_curvature_(half_curvature),
        column_m_(range_m) {
    sight_.posts = posts;
  }

  /// @param post  between the antenna, or at it, and the column; each one farther than the one before
  EMSCAPE_HD void add(const SightPost& post) {
    look(post);
    if (!(post.range_m > 0 && column_m_ > post.range_m)) return;
    const float from_tx = (post.ground_m - tx_msl_m_) / post.range_m - half_curvature_ * post.range_m;
    sight_.to_ground_rad = from_tx > sight_.to_ground_rad ? from_tx : sight_.to_ground_rad;
    const SightPost here = lowered(post);
    while (sight_.count > 1) {
      const SightPost before = lowered(sight_.posts.get(sight_.count - 2));
      const bool is_corner = (last_.ground_m - before.ground_m) * (here.range_m - before.range_m) >
                             (here.ground_m - before.ground_m) * (last_.range_m - before.range_m);
      if (is_corner) break;
      --sight_.count;
      last_ = before;
    }
    sight_.posts.set(sight_.count++, post);
    last_ = here;
  }
  /// @param ground_m  below the column; NaN: unknown
  EMSCAPE_HD PeSight sight(float ground_m) {
    look({column_m_, ground_m});
    sight_.horizon_rad += unknown_;
    return sight_;
  }

 private:
  EMSCAPE_HD void look(const SightPost& post) {
    unknown_ += 0 * post.ground_m;
    if (!(post.range_m >= PeSight::kNearGround_m)) return;
    const float angle_rad = (post.ground_m - tx_msl_m_) / post.range_m - curvature_per_m_ * post.range_m / 2;
    if (angle_rad > sight_.horizon_rad) sight_.horizon_rad = angle_rad;
  }
  /// Post lowered by the curvature of the effective earth, over which rays are straight.
  EMSCAPE_HD SightPost lowered(const SightPost& post) const {
    return {post.range_m, post.ground_m - half_curvature_ * post.range_m * post.range_m};
  }

  float tx_msl_m_, curvature_per_m_, half_curvature_, column_m_;
  float unknown_ = 0;  ///< or NaN
  SightPost last_{0, 0};
  PeSight sight_;
};

}  // namespace emscape::propagation
